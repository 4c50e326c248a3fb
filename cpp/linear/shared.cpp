// The parts of ranks and the skeleton between them. With b the interior of the part of a rank, s the skeleton
// and k the kept equations,
//   S = sum over ranks of (K_rr - K_rb K_bb^-1 K_br),   r = s and k,
// is a sparse matrix of dense blocks, one for each rank, from which s is eliminated in turn.
#include <algorithm>
#include <utility>

#include "linear/condensing_solver.h"
#include "linear/skeleton.h"

namespace mortier {
namespace {

class Shared final : public CondensingSolver {
 public:
  Shared(const SparsePattern& pattern, const std::vector<int>& kept, const std::vector<int>& own,
         const CondensingSolverFactory& engine, Ranks& ranks, int distributedFrom)
      : ranks_(ranks), own_(own) {
    // 1. The equations of this rank, and those that several have.
    Vector holders = Vector::Zero(pattern.size);
    std::vector<int> number(pattern.size, -1);
    for (size_t i = 0; i < own_.size(); ++i) {
      number[own_[i]] = static_cast<int>(i);
      holders[own_[i]] = 1;
    }
    ranks_.sum(holders.data(), holders.size());
    std::vector<char> isKept(pattern.size, 0);
    for (const int each : kept) isKept[each] = 1;
    for (int j = 0; j < pattern.size; ++j)
      if (holders[j] > 1 && isKept[j] == 0) together_.push_back(j);
    together_.insert(together_.end(), kept.begin(), kept.end());

    // 2. Its part.
    SparsePattern part{static_cast<int>(own_.size()), pattern.symmetric, {0}, {}};
    for (const int j : own_) {
      for (int k = pattern.columnStart[j]; k < pattern.columnStart[j + 1]; ++k) {
        if (number[pattern.rows[k]] < 0) continue;
        part.rows.push_back(number[pattern.rows[k]]);
        entries_.push_back(k);
      }
      part.columnStart.push_back(part.entries());
    }
    std::vector<int> keptInPart;
    std::vector<char> inside(own_.size(), 1);
    for (size_t i = 0; i < together_.size(); ++i) {
      const int local = number[together_[i]];
      if (local < 0) continue;
      places_.push_back(static_cast<int>(i));
      keptInPart.push_back(local);
      inside[local] = 0;
    }
    for (size_t i = 0; i < own_.size(); ++i)
      if (inside[i] != 0) interior_.push_back(own_[i]);
    if (!own_.empty()) part_ = engine(part, keptInPart);

    // 3. The skeleton.
    skeleton_ = newSkeleton(
        {static_cast<int>(together_.size()), static_cast<int>(kept.size()), pattern.symmetric, places_},
        engine, ranks_, distributedFrom);
  }

  bool factorise(const std::vector<double>& values) override {
    if (!part_) return true;
    part_->use(threads());
    std::vector<double> own(entries_.size());
    for (size_t k = 0; k < entries_.size(); ++k) own[k] = values[entries_[k]];
    return part_->factorise(own);
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
    Vector own = f(own_);
    part_->condense(own);
    f(own_) = own;
  }

  void joinCondensed(Vector& f) const override {
    Vector shared = f(together_);
    skeleton_->condense(shared);
    f(together_) = shared;
  }

  void expandJoined(Vector& f) const override {
    Vector shared = f(together_);
    skeleton_->expand(shared);
    f(together_) = shared;
  }

  void expand(Vector& f) const override {
    if (!part_) return;
    Vector own = f(own_);
    part_->expand(own);
    f(own_) = own;
  }

  void joinExpanded(Vector& f) const override {
    Vector all = Vector::Zero(f.size());
    all(interior_) = f(interior_);
    if (ranks_.first()) all(together_) = f(together_);
    ranks_.sum(all.data(), all.size());
    f = std::move(all);
  }

 private:
  Ranks& ranks_;
  std::vector<int> own_;       ///< equations of this rank
  std::vector<int> entries_;   ///< of the pattern, of its part
  std::vector<int> interior_;  ///< those of no other rank that are not kept
  std::vector<int> together_;  ///< the skeleton, then the kept equations
  std::vector<int> places_;    ///< of those that this rank has, ascending, the kept ones of part_
  std::unique_ptr<CondensingSolver> part_;  ///< none where the rank has nothing of the matrix
  std::unique_ptr<Skeleton> skeleton_;      ///< over together_
};

}  // namespace

std::unique_ptr<CondensingSolver> sharedSolver(const SparsePattern& pattern, const std::vector<int>& kept,
                                               const std::vector<int>& own,
                                               const CondensingSolverFactory& engine, Ranks& ranks,
                                               int distributedFrom) {
  return std::make_unique<Shared>(pattern, kept, own, engine, ranks, distributedFrom);
}

}  // namespace mortier
