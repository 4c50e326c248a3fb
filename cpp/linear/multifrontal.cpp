// Multifrontal Cholesky and LU over one symbolic analysis. In the front of a supernode
//   F = [F11 F12; F21 F22]  (pivots first),   F11 = L11 U11,   L21 = F21 U11^-1,   U12 = L11^-1 F12,
// and F22 - L21 U12 is passed to the parent. Where K is symmetric U = L' and only the lower triangle is held.
// The last front stops at the kept equations: what is left of it is the Schur complement. LU pivots inside
// the pivot block only; the caller checks residuals.
#include <cmath>
#include <limits>

#include "linear/condensing_solver.h"
#include "linear/dense_kernels.h"
#include "linear/elimination.h"

namespace mortier {
namespace {

class Multifrontal final : public CondensingSolver {
 public:
  Multifrontal(const SparsePattern& pattern, const std::vector<int>& kept)
      : symmetric_(pattern.symmetric), plan_(analyse(pattern, kept)), factors_(plan_.fronts.size()) {
    for (size_t s = 0; s < plan_.fronts.size(); ++s) {
      const Front& front = plan_.fronts[s];
      const size_t rows = front.rows.size();
      const size_t pivots = front.pivots;
      factors_[s].lower = panelSize_;
      panelSize_ += rows * pivots;
      factors_[s].upper = panelSize_;
      if (!symmetric_) panelSize_ += pivots * (rows - pivots);
      factors_[s].pivot = pivotSize_;
      if (!symmetric_) pivotSize_ += pivots;
      largest_ = std::max(largest_, rows);
    }
    schur_.resize(plan_.kept, plan_.kept);
  }

  bool factorise(const std::vector<double>& values) override {
    panels_.resize(panelSize_);
    pivots_.resize(pivotSize_);
    std::vector<std::vector<double>> updates(plan_.fronts.size());
    std::vector<std::vector<int>> children(plan_.fronts.size());
    for (size_t s = 0; s < plan_.fronts.size(); ++s)
      if (plan_.fronts[s].parent >= 0) children[plan_.fronts[s].parent].push_back(static_cast<int>(s));
    std::vector<double> front;
    for (size_t s = 0; s < plan_.fronts.size(); ++s) {
      assemble(s, values, children[s], updates, front);
      if (!eliminate(s, front)) return false;
      passOn(s, front, updates[s]);
    }
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
      const double* L = &panels_[factors_[s].lower];
      if (!symmetric_) dense::swapRows(x1, &pivots_[factors_[s].pivot], pivots);
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
      const double* L = &panels_[factors_[s].lower];
      if (symmetric_) {
        dense::subtractTransposed(L + pivots, n, n - pivots, pivots, y.data(), x1);
        dense::solveLowerTransposed(L, n, pivots, x1);
      } else {
        dense::subtract(&panels_[factors_[s].upper], pivots, pivots, n - pivots, y.data(), x1);
        dense::solveUpper(L, n, pivots, x1);
      }
    }
    for (int i = 0; i < plan_.size; ++i) f[plan_.order[i]] = x[i];
  }

 private:
  /// Where the factor of a front is held: L (and U11) rows x pivots, U12 pivots x updates, interchanges.
  struct Factor {
    size_t lower = 0;
    size_t upper = 0;
    size_t pivot = 0;
  };

  [[nodiscard]] size_t lastEntry(size_t s) const {
    return s + 1 < plan_.fronts.size() ? plan_.fronts[s + 1].firstEntry : plan_.entries.size();
  }

  void assemble(size_t s, const std::vector<double>& values, const std::vector<int>& children,
                std::vector<std::vector<double>>& updates, std::vector<double>& front) const {
    const size_t n = plan_.fronts[s].rows.size();
    front.assign(n * n, 0.0);
    for (size_t k = plan_.fronts[s].firstEntry; k < lastEntry(s); ++k)
      front[plan_.positions[k]] += values[plan_.entries[k]];
    for (const int child : children) {
      const std::vector<int>& rows = plan_.fronts[child].inParent;
      const size_t m = rows.size();
      const double* update = updates[child].data();
      for (size_t j = 0; j < m; ++j) {
        double* column = &front[n * rows[j]];
        for (size_t i = symmetric_ ? j : 0; i < m; ++i) column[rows[i]] += update[m * j + i];
      }
      std::vector<double>().swap(updates[child]);
    }
  }

  bool eliminate(size_t s, std::vector<double>& front) {
    const auto n = static_cast<int>(plan_.fronts[s].rows.size());
    const int pivots = plan_.fronts[s].pivots;
    if (pivots == 0) return true;
    if (symmetric_ ? !dense::partialCholesky(front.data(), n, pivots)
                   : !dense::partialLU(front.data(), n, pivots, &pivots_[factors_[s].pivot]))
      return false;
    std::copy_n(front.begin(), static_cast<size_t>(n) * pivots, panels_.begin() + factors_[s].lower);
    if (!symmetric_)
      for (int j = pivots; j < n; ++j)
        std::copy_n(front.begin() + static_cast<size_t>(n) * j, pivots,
                    panels_.begin() + factors_[s].upper + static_cast<size_t>(pivots) * (j - pivots));
    return true;
  }

  void passOn(size_t s, const std::vector<double>& front, std::vector<double>& update) {
    const Front& plan = plan_.fronts[s];
    const size_t n = plan.rows.size();
    const size_t m = n - plan.pivots;
    const double* F22 = front.data() + (n + 1) * plan.pivots;
    if (plan.parent >= 0) {
      update.resize(m * m);
      for (size_t j = 0; j < m; ++j) std::copy_n(F22 + n * j, m, update.begin() + m * j);
    } else if (s + 1 == plan_.fronts.size()) {
      for (size_t j = 0; j < m; ++j)
        for (size_t i = symmetric_ ? j : 0; i < m; ++i) {
          schur_(i, j) = F22[n * j + i];
          if (symmetric_) schur_(j, i) = schur_(i, j);
        }
    }
  }

  bool symmetric_;
  Elimination plan_;
  std::vector<Factor> factors_;
  size_t panelSize_ = 0;
  size_t pivotSize_ = 0;
  size_t largest_ = 0;
  std::vector<double> panels_;
  std::vector<int> pivots_;
  Matrix schur_;
};

}  // namespace

std::unique_ptr<CondensingSolver> multifrontalSolver(const SparsePattern& pattern,
                                                     const std::vector<int>& kept) {
  return std::make_unique<Multifrontal>(pattern, kept);
}

}  // namespace mortier
