// The parts of ranks and the skeleton between them. With b the interior of the part of a rank, s the skeleton
// and k the kept equations,
//   S = sum over ranks of (K_rr - K_rb K_bb^-1 K_br),   r = s and k,
// is a sparse matrix of dense blocks, one for each rank, from which s is eliminated in turn.
#include <utility>

#include "linear/condensing_solver.h"
#include "linear/skeleton.h"

namespace mortier {
namespace {

class Shared final : public CondensingSolver {
 public:
  Shared(const SparsePattern& part, const std::vector<int>& kept, const SharedEquations& shared,
         const CondensingSolverFactory& engine, Ranks& ranks, int distributedFrom)
      : kept_(kept), size_(part.size) {
    // 1. The skeleton: equations that several ranks have, but for those that are kept.
    std::vector<char> isKept(part.size, 0);
    for (const int each : kept)
      if (each < part.size) isKept[each] = 1;
    Vector holders = Vector::Zero(shared.count);
    for (size_t i = 0; i < shared.equations.size(); ++i)
      if (isKept[shared.equations[i]] == 0) holders[shared.numbers[i]] = 1;
    ranks.sum(holders.data(), holders.size());
    std::vector<int> place(shared.count, -1);
    for (int number = 0; number < shared.count; ++number)
      if (holders[number] > 1) place[number] = skeletonSize_++;

    // 2. The part of this rank, with both kept.
    for (size_t i = 0; i < shared.equations.size(); ++i) {
      const int number = shared.numbers[i];
      if (place[number] < 0 || isKept[shared.equations[i]] != 0) continue;
      equations_.push_back(shared.equations[i]);
      places_.push_back(place[number]);
    }
    for (size_t i = 0; i < kept.size(); ++i) {
      if (kept[i] >= part.size) continue;
      equations_.push_back(kept[i]);
      places_.push_back(skeletonSize_ + static_cast<int>(i));
    }
    if (part.size > 0) part_ = engine(part, equations_);

    // 3. The skeleton.
    const auto keptSize = static_cast<int>(kept.size());
    together_ = skeletonSize_ + keptSize;
    skeleton_ = newSkeleton({together_, keptSize, part.symmetric, places_}, engine, ranks, distributedFrom);
  }

  bool factorise(const std::vector<double>& values) override {
    if (!part_) return true;
    part_->use(threads());
    return part_->factorise(values);
  }

  bool join(bool regular) override {
    Matrix own;
    if (regular && part_) own = part_->takeSchurComplement();
    return skeleton_->factorise(std::move(own), regular, threads());
  }

  [[nodiscard]] const Matrix& schurComplement() const override { return skeleton_->schurComplement(); }
  [[nodiscard]] Matrix takeSchurComplement() override { return skeleton_->takeSchurComplement(); }

  void condense(Vector& f) const override {
    if (!part_) return;
    Vector own = f.head(size_);
    part_->condense(own);
    f.head(size_) = own;
  }

  void joinCondensed(Vector& f) const override {
    shared_ = Vector::Zero(together_);
    for (size_t i = 0; i < places_.size(); ++i) shared_[places_[i]] = f[equations_[i]];
    skeleton_->condense(shared_);
    f(kept_) = shared_.tail(static_cast<Eigen::Index>(kept_.size()));
  }

  void expandJoined(Vector& f) const override {
    shared_.tail(static_cast<Eigen::Index>(kept_.size())) = f(kept_);
    skeleton_->expand(shared_);
    for (size_t i = 0; i < places_.size(); ++i) f[equations_[i]] = shared_[places_[i]];
  }

  void expand(Vector& f) const override {
    if (!part_) return;
    Vector own = f.head(size_);
    part_->expand(own);
    f.head(size_) = own;
  }

 private:
  std::vector<int> kept_;
  int size_ = 0;  ///< of the part
  int skeletonSize_ = 0;
  int together_ = 0;            ///< equations of the skeleton and kept ones
  std::vector<int> equations_;  ///< of the part, of the skeleton and kept: the kept ones of part_
  std::vector<int> places_;     ///< of these among the skeleton and the kept equations of all, ascending
  std::unique_ptr<CondensingSolver> part_;  ///< none where the rank has nothing of the matrix
  std::unique_ptr<Skeleton> skeleton_;      ///< then the kept equations
  mutable Vector shared_;                   ///< right-hand side over these, condensed
};

}  // namespace

std::unique_ptr<CondensingSolver> sharedSolver(const SparsePattern& part, const std::vector<int>& kept,
                                               const SharedEquations& shared,
                                               const CondensingSolverFactory& engine, Ranks& ranks,
                                               int distributedFrom) {
  return std::make_unique<Shared>(part, kept, shared, engine, ranks, distributedFrom);
}

}  // namespace mortier
