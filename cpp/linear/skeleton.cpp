#include "linear/skeleton.h"

#include <algorithm>

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

class Replicated final : public Skeleton {
 public:
  Replicated(const SkeletonShape& shape, const CondensingSolverFactory& engine, Ranks& ranks)
      : ranks_(ranks), places_(shape.places) {
    pattern_ = patternOf(listsOfAll(places_, ranks_), shape.size, shape.symmetric);
    std::vector<int> last;
    for (int i = shape.size - shape.kept; i < shape.size; ++i) last.push_back(i);
    solver_ = engine(pattern_, last);
  }

  bool factorise(Matrix own, bool regular, Threads& threads) override {
    std::vector<double> values(pattern_.entries() + 1, 0.0);
    values.back() = regular ? 0 : 1;  // ranks that failed
    for (size_t j = 0; j < places_.size() && regular; ++j) {
      int at = pattern_.columnStart[places_[j]];
      for (size_t i = pattern_.symmetric ? j : 0; i < places_.size(); ++i) {
        while (pattern_.rows[at] != places_[i]) ++at;
        values[at] = own(static_cast<Eigen::Index>(i), static_cast<Eigen::Index>(j));
      }
    }
    own.resize(0, 0);
    ranks_.sum(values.data(), values.size());
    if (values.back() > 0) return false;
    values.pop_back();
    solver_->use(threads);
    return solver_->factorise(values);
  }

  [[nodiscard]] const Matrix& schurComplement() const override { return solver_->schurComplement(); }
  [[nodiscard]] Matrix takeSchurComplement() override { return solver_->takeSchurComplement(); }

  void condense(Vector& f) const override {
    ranks_.sum(f.data(), f.size());
    solver_->condense(f);
  }
  void expand(Vector& f) const override { solver_->expand(f); }

 private:
  Ranks& ranks_;
  std::vector<int> places_;
  SparsePattern pattern_;
  std::unique_ptr<CondensingSolver> solver_;
};

SkeletonFactory distributed = nullptr;

}  // namespace

void distributeSkeletonsBy(SkeletonFactory way) {
  distributed = way;
}

std::unique_ptr<Skeleton> replicatedSkeleton(const SkeletonShape& shape,
                                             const CondensingSolverFactory& engine, Ranks& ranks) {
  return std::make_unique<Replicated>(shape, engine, ranks);
}

std::unique_ptr<Skeleton> newSkeleton(const SkeletonShape& shape, const CondensingSolverFactory& engine,
                                      Ranks& ranks, int smallest) {
  const int eliminated = shape.size - shape.kept;
  if (distributed != nullptr && eliminated > 0 && eliminated >= smallest) return distributed(shape, ranks);
  return replicatedSkeleton(shape, engine, ranks);
}

}  // namespace mortier
