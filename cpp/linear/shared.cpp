// The parts of ranks and the skeleton between them. With b the interior of the part of a rank, s the skeleton
// and k the kept equations,
//   S = sum over ranks of (K_rr - K_rb K_bb^-1 K_br),   r = s and k,
// is a sparse matrix of dense blocks, one for each rank, from which s is eliminated in turn.
#include <algorithm>
#include <utility>

#include "linear/condensing_solver.h"

namespace mortier {
namespace {

/// The couplings of sets of equations, each with all others of its set.
SparsePattern patternOf(const std::vector<std::vector<int>>& sets, int size, bool symmetric) {
  std::vector<std::vector<int>> setsOf(size);
  for (size_t s = 0; s < sets.size(); ++s)
    for (const int each : sets[s]) setsOf[each].push_back(static_cast<int>(s));
  SparsePattern pattern{size, symmetric, {0}, {}};
  std::vector<int> rows;
  for (int column = 0; column < size; ++column) {
    rows.assign(1, column);
    for (const int s : setsOf[column])
      for (const int row : sets[s])
        if (row >= column || !symmetric) rows.push_back(row);
    std::sort(rows.begin(), rows.end());
    pattern.rows.insert(pattern.rows.end(), rows.begin(), std::unique(rows.begin(), rows.end()));
    pattern.columnStart.push_back(pattern.entries());
  }
  return pattern;
}

/// A list of each rank, known to all.
std::vector<std::vector<int>> listsOfAll(const std::vector<int>& own, Ranks& ranks) {
  const std::vector<size_t> one(ranks.count(), 1);
  std::vector<double> counts(ranks.count());
  ranks.gather({static_cast<double>(own.size())}, one, counts.data());
  const std::vector<size_t> sizes(counts.begin(), counts.end());
  size_t total = 0;
  for (const size_t size : sizes) total += size;
  std::vector<double> all(total);
  ranks.gather({own.begin(), own.end()}, sizes, all.data());
  std::vector<std::vector<int>> lists;
  auto next = all.begin();
  for (const size_t size : sizes) {
    lists.emplace_back(next, next + static_cast<std::ptrdiff_t>(size));
    next += static_cast<std::ptrdiff_t>(size);
  }
  return lists;
}

class Shared final : public CondensingSolver {
 public:
  Shared(const SparsePattern& part, const std::vector<int>& kept, const SharedEquations& shared,
         const CondensingSolverFactory& engine, Ranks& ranks)
      : ranks_(ranks), kept_(kept), size_(part.size) {
    // 1. The skeleton: equations that several ranks have, but for those that are kept.
    std::vector<char> isKept(part.size, 0);
    for (const int each : kept)
      if (each < part.size) isKept[each] = 1;
    Vector holders = Vector::Zero(shared.count);
    for (size_t i = 0; i < shared.equations.size(); ++i)
      if (isKept[shared.equations[i]] == 0) holders[shared.numbers[i]] = 1;
    ranks_.sum(holders.data(), holders.size());
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
    const int together = skeletonSize_ + static_cast<int>(kept.size());
    top_ = patternOf(listsOfAll(places_, ranks_), together, part.symmetric);
    std::vector<int> last;
    for (int i = skeletonSize_; i < together; ++i) last.push_back(i);
    skeleton_ = engine(top_, last);
  }

  bool factorise(const std::vector<double>& values) override {
    if (!part_) return true;
    part_->use(threads());
    return part_->factorise(values);
  }

  bool join(bool regular) override {
    std::vector<double> values(top_.entries() + 1, 0.0);
    values.back() = regular ? 0 : 1;  // ranks that failed
    if (regular && part_) {
      const Matrix S = part_->takeSchurComplement();
      for (size_t j = 0; j < places_.size(); ++j) {
        int at = top_.columnStart[places_[j]];
        for (size_t i = top_.symmetric ? j : 0; i < places_.size(); ++i) {
          while (top_.rows[at] != places_[i]) ++at;
          values[at] = S(static_cast<Eigen::Index>(i), static_cast<Eigen::Index>(j));
        }
      }
    }
    ranks_.sum(values.data(), values.size());
    if (values.back() > 0) return false;
    values.pop_back();
    skeleton_->use(threads());
    return skeleton_->factorise(values);
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
    shared_ = Vector::Zero(top_.size);
    for (size_t i = 0; i < places_.size(); ++i) shared_[places_[i]] = f[equations_[i]];
    ranks_.sum(shared_.data(), shared_.size());
    skeleton_->condense(shared_);
    f(kept_) = shared_.tail(static_cast<Eigen::Index>(kept_.size()));
  }

  void expand(Vector& f) const override {
    shared_.tail(static_cast<Eigen::Index>(kept_.size())) = f(kept_);
    skeleton_->expand(shared_);
    for (size_t i = 0; i < places_.size(); ++i) f[equations_[i]] = shared_[places_[i]];
    if (!part_) return;
    Vector own = f.head(size_);
    part_->expand(own);
    f.head(size_) = own;
  }

 private:
  Ranks& ranks_;
  std::vector<int> kept_;
  int size_ = 0;  ///< of the part
  int skeletonSize_ = 0;
  std::vector<int> equations_;  ///< of the part, of the skeleton and kept: the kept ones of part_
  std::vector<int> places_;     ///< of these among the skeleton and the kept equations of all, ascending
  std::unique_ptr<CondensingSolver> part_;  ///< none where the rank has nothing of the matrix
  SparsePattern top_;                       ///< of the skeleton, then the kept equations
  std::unique_ptr<CondensingSolver> skeleton_;
  mutable Vector shared_;  ///< right-hand side over these, condensed
};

}  // namespace

std::unique_ptr<CondensingSolver> sharedSolver(const SparsePattern& part, const std::vector<int>& kept,
                                               const SharedEquations& shared,
                                               const CondensingSolverFactory& engine, Ranks& ranks) {
  return std::make_unique<Shared>(part, kept, shared, engine, ranks);
}

}  // namespace mortier
