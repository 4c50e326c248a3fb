#include "solver/dense_factor.h"

#include <Eigen/Cholesky>
#include <algorithm>
#include <cmath>
#include <utility>

#include "base/interrupt.h"

namespace mortier {
namespace {

/// Columns of a panel.
constexpr Eigen::Index panel = 128;
/// Panels of LU up to this width are eliminated column by column.
constexpr Eigen::Index narrow = 8;
/// Up to as many right-hand sides are solved one by one: each panel stays in the cache meanwhile.
constexpr Eigen::Index few = 6;

/// Calls work(first, count) for one panel of columns after the other.
template <class Work>
void forEachPanel(Eigen::Index begin, Eigen::Index end, const Work& work) {
  for (Eigen::Index first = begin; first < end; first += panel) {
    stopIfInterrupted();
    work(first, std::min(panel, end - first));
  }
}

}  // namespace

bool DenseFactor::factorise(Matrix&& matrix, bool symmetric) {
  symmetric_ = symmetric;
  factor_ = std::move(matrix);
  leastPivot_ = 1;
  if (factor_.rows() == 0) return true;
  if (symmetric) {
    const Vector before = factor_.diagonal();
    if (!cholesky()) return false;
    leastPivot_ = (factor_.diagonal().array().square() / before.array()).minCoeff();
    return true;
  }
  const Vector before = factor_.colwise().lpNorm<Eigen::Infinity>();
  if (!lu()) return false;
  leastPivot_ = (factor_.diagonal().cwiseAbs().array() / before.array()).minCoeff();
  return leastPivot_ > 0;
}

int DenseFactor::sign() const {
  if (symmetric_) return 1;
  bool negative = false;
  for (Eigen::Index k = 0; k < factor_.rows(); ++k)
    negative = negative != ((factor_(k, k) < 0) != (interchange_[k] != k));
  return negative ? -1 : 1;
}

bool DenseFactor::cholesky() {
  const Eigen::Index n = factor_.rows();
  bool definite = true;
  forEachPanel(0, n, [&](Eigen::Index k, Eigen::Index columns) {
    if (!definite) return;
    Eigen::Ref<Matrix> pivots = factor_.block(k, k, columns, columns);
    definite = Eigen::LLT<Eigen::Ref<Matrix>>(pivots).info() == Eigen::Success;
    const Eigen::Index next = k + columns;
    auto below = factor_.block(next, k, n - next, columns);
    pivots.triangularView<Eigen::Lower>().adjoint().solveInPlace<Eigen::OnTheRight>(below);
    forEachPanel(next, n, [&](Eigen::Index j, Eigen::Index width) {
      const Eigen::Index rest = j + width;
      const auto across = factor_.block(j, k, width, columns);
      factor_.block(j, j, width, width).selfadjointView<Eigen::Lower>().rankUpdate(across, -1);
      factor_.block(rest, j, n - rest, width).noalias() -=
          factor_.block(rest, k, n - rest, columns) * across.transpose();
    });
  });
  return definite;
}

/// Columns [first, first + columns) from the diagonal down; rows are exchanged within these columns.
void DenseFactor::eliminatePanel(Eigen::Index first, Eigen::Index columns) {
  const Eigen::Index n = factor_.rows();
  if (columns > narrow) {
    const Eigen::Index left = columns / 2;
    const Eigen::Index right = columns - left;
    const Eigen::Index middle = first + left;
    eliminatePanel(first, left);
    auto beside = factor_.middleCols(middle, right);
    for (Eigen::Index k = first; k < middle; ++k) beside.row(k).swap(beside.row(interchange_[k]));
    factor_.block(first, first, left, left)
        .triangularView<Eigen::UnitLower>()
        .solveInPlace(factor_.block(first, middle, left, right));
    factor_.block(middle, middle, n - middle, right).noalias() -=
        factor_.block(middle, first, n - middle, left) * factor_.block(first, middle, left, right);
    eliminatePanel(middle, right);
    auto before = factor_.middleCols(first, left);
    for (Eigen::Index k = middle; k < middle + right; ++k) before.row(k).swap(before.row(interchange_[k]));
    return;
  }
  for (Eigen::Index k = first; k < first + columns; ++k) {
    Eigen::Index best = 0;
    factor_.col(k).tail(n - k).cwiseAbs().maxCoeff(&best);
    interchange_[k] = static_cast<int>(k + best);
    auto row = factor_.row(k).segment(first, columns);
    row.swap(factor_.row(k + best).segment(first, columns));
    if (factor_(k, k) == 0) continue;
    const Eigen::Index below = n - k - 1;
    const Eigen::Index rest = first + columns - k - 1;
    factor_.col(k).tail(below) /= factor_(k, k);
    factor_.block(k + 1, k + 1, below, rest).noalias() -=
        factor_.col(k).tail(below) * factor_.row(k).segment(k + 1, rest);
  }
}

bool DenseFactor::lu() {
  const Eigen::Index n = factor_.rows();
  interchange_.resize(n);
  forEachPanel(0, n, [&](Eigen::Index k, Eigen::Index columns) {
    eliminatePanel(k, columns);
    const Eigen::Index next = k + columns;
    const auto exchange = [&](auto&& block) {
      for (Eigen::Index i = k; i < next; ++i) block.row(i).swap(block.row(interchange_[i]));
    };
    exchange(factor_.leftCols(k));
    forEachPanel(next, n, [&](Eigen::Index j, Eigen::Index width) {
      exchange(factor_.middleCols(j, width));
      auto across = factor_.block(k, j, columns, width);
      factor_.block(k, k, columns, columns).triangularView<Eigen::UnitLower>().solveInPlace(across);
      factor_.block(next, j, n - next, width).noalias() -= factor_.block(next, k, n - next, columns) * across;
    });
  });
  return (factor_.diagonal().array() != 0).all();
}

template <unsigned triangle, bool transposed>
void DenseFactor::substitute(Matrix& x) const {
  const Eigen::Index n = factor_.rows();
  if (x.cols() > few) {
    if constexpr (transposed)
      factor_.triangularView<triangle>().adjoint().solveInPlace(x);
    else
      factor_.triangularView<triangle>().solveInPlace(x);
    return;
  }
  constexpr bool forward = (triangle & Eigen::Lower) != 0 && !transposed;
  const Eigen::Index panels = (n + panel - 1) / panel;
  for (Eigen::Index i = 0; i < panels; ++i) {
    const Eigen::Index first = panel * (forward ? i : panels - 1 - i);
    const Eigen::Index count = std::min(panel, n - first);
    const Eigen::Index next = first + count;
    const auto pivots = factor_.block(first, first, count, count);
    for (Eigen::Index c = 0; c < x.cols(); ++c) {
      auto own = x.col(c).segment(first, count);
      if constexpr (transposed) {
        own.noalias() -= factor_.block(next, first, n - next, count).transpose() * x.col(c).tail(n - next);
        pivots.template triangularView<triangle>().adjoint().solveInPlace(own);
      } else {
        pivots.template triangularView<triangle>().solveInPlace(own);
        if constexpr (forward)
          x.col(c).tail(n - next).noalias() -= factor_.block(next, first, n - next, count) * own;
        else
          x.col(c).head(first).noalias() -= factor_.block(0, first, first, count) * own;
      }
    }
  }
}

void DenseFactor::solve(Matrix& x) const {
  if (factor_.rows() == 0) return;
  if (symmetric_) {
    substitute<Eigen::Lower, false>(x);
    substitute<Eigen::Lower, true>(x);
    return;
  }
  for (Eigen::Index k = 0; k < factor_.rows(); ++k)
    if (interchange_[k] != k) x.row(k).swap(x.row(interchange_[k]));
  substitute<Eigen::UnitLower, false>(x);
  substitute<Eigen::Upper, false>(x);
}

}  // namespace mortier
