// Multifrontal Cholesky and LU over one symbolic analysis. In the front of a supernode
//   F = [F11 F12; F21 F22]  (pivots first),   F11 = L11 U11,   L21 = F21 U11^-1,   U12 = L11^-1 F12,
// and F22 - L21 U12 is passed to the parent. Where K is symmetric U = L' and only the lower triangle is held.
// The last front stops at the kept equations: what is left of it is the Schur complement. LU pivots inside
// the pivot block only; the caller checks residuals.
#include <algorithm>

#include "linear/condensing_solver.h"
#include "linear/dense_kernels.h"
#include "linear/elimination.h"

namespace mortier {
namespace {

class Multifrontal final : public CondensingSolver {
 public:
  Multifrontal(const SparsePattern& pattern, const std::vector<int>& kept)
      : symmetric_(pattern.symmetric), plan_(analyse(pattern, kept)), factors_(plan_.fronts.size()) {
    size_t stack = 0;
    std::vector<size_t> waiting;
    for (size_t s = 0; s < plan_.fronts.size(); ++s) {
      const Front& front = plan_.fronts[s];
      factors_[s].panel = panelSize_;
      factors_[s].upper = panelSize_ + front.panelSize();
      panelSize_ = factors_[s].upper + (symmetric_ ? 0 : front.pivots * front.updates());
      factors_[s].pivot = pivotSize_;
      if (!symmetric_) pivotSize_ += front.pivots;
      largest_ = std::max(largest_, front.rows.size());
      // An update is made on top of those of the front's children, then moved down over them.
      const size_t update = front.updates() * front.updates();
      stackSize_ = std::max(stackSize_, stack + update);
      for (size_t i = 0; i < front.children.size(); ++i) {
        stack -= waiting.back();
        waiting.pop_back();
      }
      waiting.push_back(update);
      stack += update;
    }
    schur_.resize(plan_.kept, plan_.kept);
  }

  bool factorise(const std::vector<double>& values) override {
    panels_.assign(panelSize_, 0.0);
    pivots_.resize(pivotSize_);
    if (!stack_) stack_ = std::make_unique_for_overwrite<double[]>(stackSize_);
    double* top = stack_.get();
    for (size_t s = 0; s < plan_.fronts.size(); ++s) {
      const Front& front = plan_.fronts[s];
      const size_t m = front.updates();
      double* update = top;
      std::fill_n(update, m * m, 0.0);
      assemble(s, values, update);
      const double* child = top;
      for (size_t i = front.children.size(); i-- > 0;) {
        const Front& from = plan_.fronts[front.children[i]];
        child -= from.updates() * from.updates();
        extendAdd(s, from, child, update);
      }
      if (!eliminate(s, update)) return false;
      top = std::copy_n(update, m * m, stack_.get() + (child - stack_.get()));
    }
    keepSchurComplement(top - schur_.size());
    return true;
  }

  [[nodiscard]] const Matrix& schurComplement() const override { return schur_; }

  void condense(Vector& f) const override {
    Vector x(plan_.size);
    for (int i = 0; i < plan_.size; ++i) x[i] = f[plan_.order[i]];
    Vector y(static_cast<Eigen::Index>(largest_));
    for (size_t s = 0; s < plan_.fronts.size(); ++s) {
      const Front& front = plan_.fronts[s];
      const auto n = static_cast<int>(front.rows.size());
      const int pivots = front.pivots;
      if (pivots == 0) continue;
      double* x1 = &x[front.rows[0]];
      const double* L = panels_.data() + factors_[s].panel;
      if (!symmetric_) dense::swapRows(x1, pivots_.data() + factors_[s].pivot, pivots);
      dense::solveLower(L, n, pivots, !symmetric_, x1);
      dense::multiply(L + pivots, n, n - pivots, pivots, x1, y.data());
      for (int i = pivots; i < n; ++i) x[front.rows[i]] -= y[i - pivots];
    }
    for (int i = 0; i < plan_.size; ++i) f[plan_.order[i]] = x[i];
  }

  void expand(Vector& f) const override {
    Vector x(plan_.size);
    for (int i = 0; i < plan_.size; ++i) x[i] = f[plan_.order[i]];
    Vector y(static_cast<Eigen::Index>(largest_));
    for (size_t s = plan_.fronts.size(); s-- > 0;) {
      const Front& front = plan_.fronts[s];
      const auto n = static_cast<int>(front.rows.size());
      const int pivots = front.pivots;
      if (pivots == 0) continue;
      double* x1 = &x[front.rows[0]];
      for (int i = pivots; i < n; ++i) y[i - pivots] = x[front.rows[i]];
      const double* L = panels_.data() + factors_[s].panel;
      if (symmetric_) {
        dense::subtractTransposed(L + pivots, n, n - pivots, pivots, y.data(), x1);
        dense::solveLowerTransposed(L, n, pivots, x1);
      } else {
        dense::subtract(panels_.data() + factors_[s].upper, pivots, pivots, n - pivots, y.data(), x1);
        dense::solveUpper(L, n, pivots, x1);
      }
    }
    for (int i = 0; i < plan_.size; ++i) f[plan_.order[i]] = x[i];
  }

 private:
  /// Where the factor of a front is held.
  struct Factor {
    size_t panel = 0;
    size_t upper = 0;
    size_t pivot = 0;
  };

  void assemble(size_t s, const std::vector<double>& values, double* update) {
    const size_t last = s + 1 < plan_.fronts.size() ? plan_.fronts[s + 1].firstEntry : plan_.entries.size();
    double* factor = panels_.data() + factors_[s].panel;
    const size_t held =
        (s + 1 < plan_.fronts.size() ? factors_[s + 1].panel : panelSize_) - factors_[s].panel;
    for (size_t k = plan_.fronts[s].firstEntry; k < last; ++k) {
      const size_t at = plan_.positions[k];
      (at < held ? factor[at] : update[at - held]) += values[plan_.entries[k]];
    }
  }

  void extendAdd(size_t s, const Front& from, const double* child, double* update) {
    const Front& front = plan_.fronts[s];
    const size_t n = front.rows.size();
    const int pivots = front.pivots;
    const size_t updates = front.updates();
    const std::vector<int>& rows = from.inParent;
    const size_t m = rows.size();
    const size_t split = std::lower_bound(rows.begin(), rows.end(), pivots) - rows.begin();
    for (size_t j = 0; j < m; ++j, child += m) {
      if (j < split) {
        double* column = panels_.data() + factors_[s].panel + n * rows[j];
        for (size_t i = symmetric_ ? j : 0; i < m; ++i) column[rows[i]] += child[i];
        continue;
      }
      if (!symmetric_) {
        double* column =
            panels_.data() + factors_[s].upper + static_cast<size_t>(pivots) * (rows[j] - pivots);
        for (size_t i = 0; i < split; ++i) column[rows[i]] += child[i];
      }
      double* column = update + updates * (rows[j] - pivots) - pivots;
      for (size_t i = symmetric_ ? j : split; i < m; ++i) column[rows[i]] += child[i];
    }
  }

  bool eliminate(size_t s, double* update) {
    const Front& front = plan_.fronts[s];
    if (front.pivots == 0) return true;
    const auto n = static_cast<int>(front.rows.size());
    double* panel = panels_.data() + factors_[s].panel;
    if (symmetric_) return dense::partialCholesky(panel, n, front.pivots, update);
    return dense::partialLU(panel, n, front.pivots, panels_.data() + factors_[s].upper, update,
                            pivots_.data() + factors_[s].pivot);
  }

  void keepSchurComplement(const double* update) {
    const Eigen::Index m = schur_.rows();
    for (Eigen::Index j = 0; j < m; ++j)
      for (Eigen::Index i = symmetric_ ? j : 0; i < m; ++i) {
        schur_(i, j) = update[m * j + i];
        if (symmetric_) schur_(j, i) = schur_(i, j);
      }
  }

  bool symmetric_;
  Elimination plan_;
  std::vector<Factor> factors_;
  size_t panelSize_ = 0;
  size_t pivotSize_ = 0;
  size_t stackSize_ = 0;
  size_t largest_ = 0;
  std::vector<double> panels_;
  std::vector<int> pivots_;
  std::unique_ptr<double[]> stack_;
  Matrix schur_;
};

}  // namespace

std::unique_ptr<CondensingSolver> multifrontalSolver(const SparsePattern& pattern,
                                                     const std::vector<int>& kept) {
  dense::useOneThread();
  return std::make_unique<Multifrontal>(pattern, kept);
}

}  // namespace mortier
