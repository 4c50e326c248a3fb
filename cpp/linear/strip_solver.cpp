#include "linear/strip_solver.h"

#include <algorithm>
#include <numeric>

#include "base/interrupt.h"
#include "linear/dense_kernels.h"

namespace mortier {
namespace {

/// Rows of a front in the root mean square, above which the graph is not narrow.
constexpr double narrow = 128;

/// The neighbours of each equation, itself among them, and their entries.
struct Graph {
  struct Neighbour {
    int equation;
    int entry;
  };
  std::vector<int> start;
  std::vector<Neighbour> all;

  explicit Graph(const SparsePattern& pattern) : start(pattern.size + 1, 0) {
    const auto forEach = [&](auto visit) {
      for (int c = 0; c < pattern.size; ++c)
        for (int k = pattern.columnStart[c]; k < pattern.columnStart[c + 1]; ++k) {
          visit(c, pattern.rows[k], k);
          if (pattern.rows[k] != c) visit(pattern.rows[k], c, k);
        }
    };
    forEach([&](int of, int, int) { ++start[of + 1]; });
    std::partial_sum(start.begin(), start.end(), start.begin());
    all.resize(start.back());
    std::vector<int> next(start.begin(), start.end() - 1);
    forEach([&](int of, int equation, int entry) { all[next[of]++] = {equation, entry}; });
  }

  /// Appends what can be reached from an equation, as breadth-first search finds it; `position` is where.
  void walk(int from, std::vector<int>& order, std::vector<int>& position) const {
    const auto put = [&](int equation) {
      position[equation] = static_cast<int>(order.size());
      order.push_back(equation);
    };
    size_t at = order.size();
    put(from);
    for (; at < order.size(); ++at)
      for (int k = start[order[at]]; k < start[order[at] + 1]; ++k)
        if (position[all[k].equation] < 0) put(all[k].equation);
  }
};

class StripSolver final : public CondensingSolver {
 public:
  explicit StripSolver(const SparsePattern& pattern) : graph_(pattern), position_(pattern.size, -1) {
    arrange();
    cutIntoFronts();
  }

  [[nodiscard]] bool isNarrow() const {
    double squares = 0;
    for (const Front& front : fronts_) squares += static_cast<double>(front.pivots) * front.rows * front.rows;
    return squares <= narrow * narrow * static_cast<double>(order_.size());
  }

  bool factorise(const std::vector<double>& values) override {
    panels_.assign(panelSize_, 0);
    std::vector<double> update(largest_ * largest_);
    std::vector<double> before(update.size());
    int held = 0;  // rows of `before`
    for (const Front& front : fronts_) {
      stopIfInterrupted();
      const int n = front.rows;
      const int rest = n - front.pivots;
      double* const panel = panels_.data() + front.panel;
      for (int c = 0; c < front.pivots; ++c) {
        const int equation = order_[front.first + c];
        for (int k = graph_.start[equation]; k < graph_.start[equation + 1]; ++k) {
          const int row = position_[graph_.all[k].equation] - front.first;
          if (row >= c) panel[row + static_cast<size_t>(n) * c] = values[graph_.all[k].entry];
        }
      }
      const auto addBefore = [&](int column, int skipped, double* target) {
        const double* from = before.data() + static_cast<size_t>(held) * column;
        for (int row = column; row < held; ++row) target[row - skipped] += from[row];
      };
      for (int c = 0; c < std::min(front.pivots, held); ++c)
        addBefore(c, 0, panel + static_cast<size_t>(n) * c);
      if (!dense::partialCholesky(panel, n, front.pivots, update.data(), threads())) return false;
      for (int c = front.pivots; c < held; ++c)
        addBefore(c, front.pivots, update.data() + static_cast<size_t>(rest) * (c - front.pivots));
      update.swap(before);
      held = rest;
    }
    return true;
  }

  [[nodiscard]] const Matrix& schurComplement() const override { return none_; }
  [[nodiscard]] Matrix takeSchurComplement() override { return none_; }

  void condense(Vector& f) const override {
    Vector x = f(order_);
    Vector y(static_cast<Eigen::Index>(largest_));
    for (const Front& front : fronts_) {
      const double* const L = panels_.data() + front.panel;
      const int rest = front.rows - front.pivots;
      dense::solveLower(L, front.rows, front.pivots, false, &x[front.first]);
      dense::multiply(L + front.pivots, front.rows, rest, front.pivots, &x[front.first], y.data());
      x.segment(front.first + front.pivots, rest) -= y.head(rest);
    }
    f(order_) = x;
  }

  void expand(Vector& f) const override {
    Vector x = f(order_);
    for (size_t i = fronts_.size(); i-- > 0;) {
      const Front& front = fronts_[i];
      const double* const L = panels_.data() + front.panel;
      double* const own = &x[front.first];
      dense::subtractTransposed(L + front.pivots, front.rows, front.rows - front.pivots, front.pivots,
                                own + front.pivots, own);
      dense::solveLowerTransposed(L, front.rows, front.pivots, own);
    }
    f(order_) = x;
  }

 private:
  /// Of the equations at the positions [first, first + rows), the first `pivots` of which are eliminated.
  struct Front {
    int first, pivots, rows;
    size_t panel;  ///< where its columns of the factor are
  };

  /// Each part of the graph from one end, which is where a walk from anywhere ends, to the other.
  void arrange() {
    std::vector<int> trial(position_);
    order_.reserve(position_.size());
    for (size_t equation = 0; equation < position_.size(); ++equation) {
      if (position_[equation] >= 0) continue;
      std::vector<int> reached;
      graph_.walk(static_cast<int>(equation), reached, trial);
      graph_.walk(reached.back(), order_, position_);
    }
    std::reverse(order_.begin(), order_.end());
    for (size_t i = 0; i < order_.size(); ++i) position_[order_[i]] = static_cast<int>(i);
  }

  void cutIntoFronts() {
    constexpr int fewest = 8;
    constexpr int most = 48;
    const auto size = static_cast<int>(order_.size());
    int end = 0;  // of the positions that have been reached
    const auto reach = [&](int position) {
      const int equation = order_[position];
      for (int k = graph_.start[equation]; k < graph_.start[equation + 1]; ++k)
        end = std::max(end, position_[graph_.all[k].equation] + 1);
    };
    for (int first = 0; first < size;) {
      reach(first);
      const int pivots = std::min(std::clamp((end - first) / 2, fewest, most), size - first);
      for (int c = 1; c < pivots; ++c) reach(first + c);
      fronts_.push_back({first, pivots, end - first, panelSize_});
      panelSize_ += static_cast<size_t>(end - first) * pivots;
      largest_ = std::max(largest_, static_cast<size_t>(end - first));
      first += pivots;
    }
  }

  Graph graph_;
  std::vector<int> order_, position_;
  std::vector<Front> fronts_;
  size_t panelSize_ = 0;
  size_t largest_ = 0;
  std::vector<double> panels_;
  Matrix none_;
};

}  // namespace

std::unique_ptr<CondensingSolver> stripSolver(const SparsePattern& pattern) {
  auto solver = std::make_unique<StripSolver>(pattern);
  if (solver->isNarrow()) return solver;
  return multifrontalSolver(pattern, {});
}

}  // namespace mortier
