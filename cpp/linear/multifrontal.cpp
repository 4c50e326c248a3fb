// Multifrontal Cholesky and LU over one symbolic analysis. In the front of a supernode
//   F = [F11 F12; F21 F22]  (pivots first),   F11 = L11 U11,   L21 = F21 U11^-1,   U12 = L11^-1 F12,
// and F22 - L21 U12 is passed to the parent. Where K is symmetric U = L' and only the lower triangle is held.
// The last front stops at the kept equations: its remainder is the Schur complement. LU pivots inside
// the pivot block only; the caller checks residuals. Threads work on the pieces of the elimination tree.
// In single precision K is scaled by a power of two, and so are right-hand sides: none leaves its range.
#include "linear/condensing_solver.h"

#include <sys/mman.h>

#include <algorithm>
#include <atomic>
#include <cmath>
#include <cstdint>
#include <stdexcept>
#include <type_traits>
#include <utility>

#include "base/interrupt.h"
#include "linear/blas.h"
#include "linear/dense_kernels.h"
#include "linear/elimination.h"

namespace mortier {
namespace {

/// Memory without values. Small pages would take a tenth of the time of a factorisation to be mapped.
template <class Real>
std::unique_ptr<Real[]> inLargePages(size_t count) {
  auto memory = std::make_unique_for_overwrite<Real[]>(count);
#ifdef MADV_HUGEPAGE
  constexpr size_t page = 4096;
  const auto address = reinterpret_cast<std::uintptr_t>(memory.get());
  const size_t skipped = (page - address % page) % page;
  if (const size_t bytes = count * sizeof(Real); bytes >= (size_t{1} << 22))
    madvise(reinterpret_cast<char*>(memory.get()) + skipped, bytes - skipped, MADV_HUGEPAGE);  // a hint
#endif
  return memory;
}

/// Real: double, or float for symmetric patterns.
template <class Real>
class Multifrontal final : public CondensingSolver {
 public:
  Multifrontal(const SparsePattern& pattern, const std::vector<int>& kept)
      : symmetric_(pattern.symmetric),
        plan_(analyse(pattern, kept)),
        pieces_(cutIntoPieces(plan_.fronts)),
        factors_(plan_.fronts.size()),
        updates_(plan_.fronts.size()),
        stacks_(pieces_.all.size()) {
    dense::useOneThread();
    for (size_t s = 0; s < plan_.fronts.size(); ++s) {
      const Front& front = plan_.fronts[s];
      factors_[s] = {panelSize_, panelSize_ + front.panelSize(), pivotSize_};
      panelSize_ = factors_[s].upper + (symmetric_ ? 0 : front.pivots * front.updates());
      if (!symmetric_) pivotSize_ += front.pivots;
      largest_ = std::max(largest_, front.rows.size());
    }
  }

  bool factorise(const std::vector<double>& values) override {
    if (!panels_) panels_ = inLargePages<Real>(panelSize_);
    scale_ = scaleOf(values.data(), values.size());
    pivots_.resize(pivotSize_);
    std::atomic<bool> regular = true;
    threads().upward(pieces_.parent, [&](int p) {
      if (regular && !factorisePiece(p, values)) regular = false;
    });
    if (regular && plan_.size > 0) keepSchurComplement(updates_.back());
    for (auto& stack : stacks_) stack.reset();
    return regular;
  }

  [[nodiscard]] const Matrix& schurComplement() const override { return schur_; }
  [[nodiscard]] Matrix takeSchurComplement() override { return std::move(schur_); }

  void condense(Vector& f) const override {
    const double scale = scaleOf(f.data(), f.size());
    Reals x = inOrder(f, scale);
    std::vector<Real*> passed(plan_.fronts.size());
    std::vector<std::unique_ptr<Real[]>> stacks(pieces_.all.size());
    threads().upward(pieces_.parent, [&](int p) {
      stacks[p] = std::make_unique_for_overwrite<Real[]>(pieces_.all[p].vectorStack);
      condensePiece(pieces_.all[p], x, stacks[p].get(), passed);
      for (const int child : pieces_.all[p].children) stacks[child].reset();
    });
    putBack(x, f, scale_ / scale, 1 / scale);
  }

  void expand(Vector& f) const override {
    const double scale = scaleOf(f.data(), f.size());
    Reals x = inOrder(f, scale);
    threads().downward(pieces_.parent, [&](int p) {
      Reals y(static_cast<Eigen::Index>(largest_));
      for (int s = pieces_.all[p].last; s >= pieces_.all[p].first; --s) {
        const Front& front = plan_.fronts[s];
        const auto n = static_cast<int>(front.rows.size());
        const int pivots = front.pivots;
        if (pivots == 0) continue;
        Real* x1 = &x[front.rows[0]];
        for (int i = pivots; i < n; ++i) y[i - pivots] = x[front.rows[i]];
        const Real* L = panel(s);
        if (symmetric_) {
          subtractTransposed(L + pivots, n, n - pivots, pivots, y.data(), x1);
          dense::solveLowerTransposed(L, n, pivots, x1);
        } else if constexpr (isDouble) {
          subtractTransposed(upper(s), n - pivots, n - pivots, pivots, y.data(), x1);
          dense::solveUpper(L, n, pivots, x1);
        }
      }
    });
    putBack(x, f, 1 / scale, 1 / scale);
  }

 private:
  static constexpr bool isDouble = std::is_same_v<Real, double>;
  using Reals = Eigen::Matrix<Real, Eigen::Dynamic, 1>;

  /// Where the factor of a front is held.
  struct Factor {
    size_t panel = 0;
    size_t upper = 0;  ///< U12'
    size_t pivot = 0;
  };

  [[nodiscard]] Real* panel(int s) const { return panels_.get() + factors_[s].panel; }
  [[nodiscard]] Real* upper(int s) const { return panels_.get() + factors_[s].upper; }

  /// Calls work(begin, end) for parts of [0, n).
  template <class Work>
  void forEachPart(size_t n, size_t part, const Work& work) const {
    if (n <= part) return work(0, n);
    threads().forEach(static_cast<int>((n + part - 1) / part),
                      [&](int i) { work(part * i, std::min(part * (i + 1), n)); });
  }

  static constexpr size_t equations = 1 << 15;  ///< of a vector, worth a lock

  /// Rows of so many entries that are worth a lock.
  [[nodiscard]] static size_t rowsAtOnce(size_t entries) {
    constexpr size_t worthALock = 1 << 16;
    return std::max<size_t>(worthALock / std::max<size_t>(entries, 1), 1);
  }

  /// y -= A' x, A rows x count.
  void subtractTransposed(const Real* A, int ld, int rows, int count, const Real* x, Real* y) const {
    forEachPart(count, rowsAtOnce(rows), [&](size_t begin, size_t end) {
      dense::subtractTransposed(A + ld * begin, ld, rows, static_cast<int>(end - begin), x, y + begin);
    });
  }

  /// The power of two that brings the largest of them close to one; 1 in double precision.
  [[nodiscard]] static double scaleOf(const double* values, size_t count) {
    double largest = 0;
    for (size_t i = 0; i < count && !isDouble; ++i) largest = std::max(largest, std::abs(values[i]));
    return largest > 0 && std::isfinite(largest) ? std::ldexp(1.0, -std::ilogb(largest)) : 1;
  }

  [[nodiscard]] Reals inOrder(const Vector& f, double scale) const {
    Reals x(f.size());
    forEachPart(plan_.order.size(), equations, [&](size_t begin, size_t end) {
      for (size_t i = begin; i < end; ++i) x[i] = static_cast<Real>(scale * f[plan_.order[i]]);
    });
    return x;
  }

  void putBack(const Reals& x, Vector& f, double interiorScale, double keptScale) const {
    const size_t interior = plan_.size - plan_.kept;
    forEachPart(plan_.order.size(), equations, [&](size_t begin, size_t end) {
      for (size_t i = begin; i < end; ++i)
        f[plan_.order[i]] = x[i] * (i < interior ? interiorScale : keptScale);
    });
  }

  bool factorisePiece(int p, const std::vector<double>& values) {
    const Piece& piece = pieces_.all[p];
    stacks_[p] = std::make_unique_for_overwrite<Real[]>(piece.stack);
    Real* top = stacks_[p].get();
    for (int s = piece.first; s <= piece.last; ++s) {
      stopIfInterrupted();
      const Front& front = plan_.fronts[s];
      const size_t m = front.updates();
      Real* update = top;
      const size_t held = front.panelSize() + (symmetric_ ? 0 : front.pivots * m);
      const bool shared = dense::isLarge(static_cast<int>(front.rows.size()), front.pivots);
      const size_t part = shared ? columns : std::max<size_t>(front.rows.size(), 1);
      forEachPart(held, part * front.rows.size(),
                  [&](size_t begin, size_t end) { std::fill(panel(s) + begin, panel(s) + end, Real(0)); });
      assemble(s, values, 0, held, panel(s));
      forEachPart(front.pivots, part, [&](size_t begin, size_t end) {
        for (const int child : front.children) extendAddPanel(s, child, begin, end);
      });
      if (!eliminate(s, update)) return false;
      if (front.parent < 0) assemble(s, values, held, held + m * m, update);
      forEachPart(m, part, [&](size_t begin, size_t end) {
        for (const int child : front.children) extendAddUpdate(s, child, update, begin, end);
      });
      updates_[s] = update;
      if (piece.children.empty() && !front.children.empty()) {
        updates_[s] = updates_[front.children.front()];
        std::copy_n(update, m * m, updates_[s]);
      }
      top = updates_[s] + m * m;
    }
    for (const int child : piece.children) stacks_[child].reset();
    return true;
  }

  /// Adds the front's entries placed in [begin, end), the first of them to target[0].
  void assemble(size_t s, const std::vector<double>& values, size_t begin, size_t end, Real* target) const {
    const size_t last = s + 1 < plan_.fronts.size() ? plan_.fronts[s + 1].firstEntry : plan_.entries.size();
    for (size_t k = plan_.fronts[s].firstEntry; k < last; ++k) {
      const size_t at = plan_.positions[k];
      if (at >= begin && at < end) target[at - begin] += static_cast<Real>(scale_ * values[plan_.entries[k]]);
    }
  }

  static constexpr size_t columns = 64;  ///< of a large front that a thread takes at once

  /// How many rows of a child's update come before a row of its parent, in which the pivots come first.
  [[nodiscard]] static size_t rowsBefore(const std::vector<int>& rows, size_t row) {
    return std::lower_bound(rows.begin(), rows.end(), static_cast<int>(row)) - rows.begin();
  }

  /// In the columns [begin, end) of the panel.
  void extendAddPanel(int s, int childIndex, size_t begin, size_t end) {
    const Front& front = plan_.fronts[s];
    const std::vector<int>& rows = plan_.fronts[childIndex].inParent;
    const size_t n = front.rows.size();
    const size_t m = rows.size();
    const size_t split = rowsBefore(rows, front.pivots);
    const size_t first = rowsBefore(rows, begin);
    const size_t last = rowsBefore(rows, end);
    const Real* child = updates_[childIndex];
    for (size_t j = first; j < last; ++j) {
      Real* column = panel(s) + n * rows[j];
      for (size_t i = symmetric_ ? j : 0; i < m; ++i) column[rows[i]] += child[m * j + i];
    }
    if (symmetric_) return;
    const size_t updates = front.updates();
    for (size_t j = split; j < m; ++j) {
      Real* row = upper(s) + (rows[j] - front.pivots);
      for (size_t i = first; i < last; ++i) row[updates * rows[i]] += child[m * j + i];
    }
  }

  /// In the columns [begin, end) of the update.
  void extendAddUpdate(int s, int childIndex, Real* update, size_t begin, size_t end) {
    const Front& front = plan_.fronts[s];
    const std::vector<int>& rows = plan_.fronts[childIndex].inParent;
    const size_t updates = front.updates();
    const size_t m = rows.size();
    const size_t split = rowsBefore(rows, front.pivots);
    const size_t last = rowsBefore(rows, front.pivots + end);
    const Real* child = updates_[childIndex];
    for (size_t j = rowsBefore(rows, front.pivots + begin); j < last; ++j) {
      Real* column = update + updates * (rows[j] - front.pivots) - front.pivots;
      for (size_t i = symmetric_ ? j : split; i < m; ++i) column[rows[i]] += child[m * j + i];
    }
  }

  bool eliminate(int s, Real* update) {
    const Front& front = plan_.fronts[s];
    const auto n = static_cast<int>(front.rows.size());
    if (front.pivots == 0) {
      std::fill_n(update, front.updates() * front.updates(), Real(0));
      return true;
    }
    if (symmetric_) return dense::partialCholesky(panel(s), n, front.pivots, update, threads());
    if constexpr (isDouble)
      return dense::partialLU(panel(s), n, front.pivots, upper(s), update, pivots_.data() + factors_[s].pivot,
                              threads());
    return false;
  }

  void keepSchurComplement(const Real* update) {
    const Eigen::Index m = plan_.kept;
    using Square = Eigen::Matrix<Real, Eigen::Dynamic, Eigen::Dynamic>;
    schur_ = Eigen::Map<const Square>(update, m, m).template cast<double>() / scale_;
    if (symmetric_) schur_.triangularView<Eigen::StrictlyUpper>() = schur_.transpose();
  }

  /// x1 becomes L11^-1 (x1 - sum of what children pass), and that sum plus L21 x1 is passed on.
  void condensePiece(const Piece& piece, Reals& x, Real* top, std::vector<Real*>& passed) const {
    for (int s = piece.first; s <= piece.last; ++s) {
      const Front& front = plan_.fronts[s];
      const auto n = static_cast<int>(front.rows.size());
      const int pivots = front.pivots;
      Real* sum = top;
      Real* product = top + n;
      std::fill_n(sum, n, Real(0));
      for (const int child : front.children) {
        const std::vector<int>& rows = plan_.fronts[child].inParent;
        for (size_t i = 0; i < rows.size(); ++i) sum[rows[i]] += passed[child][i];
      }
      if (pivots > 0) {
        Real* x1 = &x[front.rows[0]];
        for (int i = 0; i < pivots; ++i) x1[i] -= sum[i];
        const Real* L = panel(s);
        if constexpr (isDouble)
          if (!symmetric_) dense::swapRows(x1, pivots_.data() + factors_[s].pivot, pivots);
        dense::solveLower(L, n, pivots, !symmetric_, x1);
        forEachPart(n - pivots, rowsAtOnce(pivots), [&](size_t begin, size_t end) {
          dense::multiply(L + pivots + begin, n, static_cast<int>(end - begin), pivots, x1, product + begin);
        });
        for (int i = pivots; i < n; ++i) sum[i] += product[i - pivots];
      }
      if (front.parent < 0)  // the last front keeps its other rows
        for (int i = pivots; i < n; ++i) x[front.rows[i]] -= sum[i];
      passed[s] = top;
      if (piece.children.empty() && !front.children.empty()) passed[s] = passed[front.children.front()];
      std::copy_n(sum + pivots, n - pivots, passed[s]);
      top = passed[s] + (n - pivots);
    }
  }

  bool symmetric_;
  Elimination plan_;
  Pieces pieces_;
  std::vector<Factor> factors_;
  size_t panelSize_ = 0;
  size_t pivotSize_ = 0;
  size_t largest_ = 0;
  double scale_ = 1;  ///< of the factors
  std::unique_ptr<Real[]> panels_;
  std::vector<int> pivots_;
  std::vector<Real*> updates_;                   ///< of each front, while its parent waits for it
  std::vector<std::unique_ptr<Real[]>> stacks_;  ///< of each piece: its updates
  Matrix schur_;
};

}  // namespace

std::unique_ptr<CondensingSolver> multifrontalSolver(const SparsePattern& pattern,
                                                     const std::vector<int>& kept) {
  return std::make_unique<Multifrontal<double>>(pattern, kept);
}

std::unique_ptr<CondensingSolver> singleSolver(const SparsePattern& pattern, const std::vector<int>& kept) {
  if (!pattern.symmetric) throw std::logic_error("factors in single precision are of symmetric matrices");
  return std::make_unique<Multifrontal<float>>(pattern, kept);
}

}  // namespace mortier
