#include "linear/dense_kernels.h"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <experimental/simd>
#include <utility>
#include <vector>

#include "base/interrupt.h"
#include "linear/blas.h"

extern "C" {
void dgetrf_(const int* m, const int* n, double* a, const int* lda, int* ipiv, int* info);
void dlaswp_(const int* n, double* a, const int* lda, const int* first, const int* last, const int* ipiv,
             const int* step);
}

namespace mortier::dense {
namespace {

namespace stdx = std::experimental;

/// Below this many pivots a call of BLAS costs more than the loops it saves.
constexpr int smallPivots = 12;
constexpr int smallRows = 96;

bool isSmall(int n, int pivots) {
  return pivots <= smallPivots && n <= smallRows;
}

/// In two running sums of four: without leave to reorder, the compiler keeps one.
template <class Real>
Real dot(const Real* x, const Real* y, int n) {
  using Eight = stdx::fixed_size_simd<Real, 8>;
  Eight sum = 0;
  int i = 0;
  for (; i + 8 <= n; i += 8) sum += Eight(x + i, stdx::element_aligned) * Eight(y + i, stdx::element_aligned);
  Real result = stdx::reduce(sum);
  for (; i < n; ++i) result += x[i] * y[i];
  return result;
}

/// In the first `rows` rows, as swapRows does with rows.
void swapColumns(double* A, int ld, int rows, const int* interchange, int n) {
  for (int k = 0; k < n; ++k)
    if (interchange[k] != k)
      std::swap_ranges(A + static_cast<size_t>(ld) * k, A + static_cast<size_t>(ld) * k + rows,
                       A + static_cast<size_t>(ld) * interchange[k]);
}

/// NaN anywhere in a factorised block has reached its diagonal.
template <class Real>
bool finiteDiagonal(const Real* panel, int n, int pivots) {
  for (int k = 0; k < pivots; ++k)
    if (!std::isfinite(panel[static_cast<size_t>(n) * k + k])) return false;
  return true;
}

/// Rows [i, i + size of Rows) and `columns` columns from j of update = -L21 U12; U12' and L21 by columns.
template <class Rows, int columns, class Real>
void updateBlock(const Real* L21, int ldL, int pivots, const Real* upper, int ldU, int i, int j, Real* update,
                 int ld) {
  Rows sum[columns];
  for (Rows& each : sum) each = 0;
  for (int k = 0; k < pivots; ++k) {
    const Rows L(L21 + static_cast<size_t>(ldL) * k + i, stdx::element_aligned);
    const Real* u = upper + static_cast<size_t>(ldU) * k + j;
    for (int c = 0; c < columns; ++c) sum[c] -= L * u[c];
  }
  for (int c = 0; c < columns; ++c)
    sum[c].copy_to(update + static_cast<size_t>(ld) * (j + c) + i, stdx::element_aligned);
}

template <int columns, class Real>
void updateColumns(const Real* L21, int ldL, int pivots, const Real* upper, int ldU, int rest, int i, int j,
                   Real* update) {
  using Eight = stdx::fixed_size_simd<Real, 8>;
  using Four = stdx::fixed_size_simd<Real, 4>;
  using One = stdx::fixed_size_simd<Real, 1>;
  for (; i + 8 <= rest; i += 8) updateBlock<Eight, columns>(L21, ldL, pivots, upper, ldU, i, j, update, rest);
  for (; i + 4 <= rest; i += 4) updateBlock<Four, columns>(L21, ldL, pivots, upper, ldU, i, j, update, rest);
  for (; i < rest; ++i) updateBlock<One, columns>(L21, ldL, pivots, upper, ldU, i, j, update, rest);
}

/// update = -L21 U12; with `lower`, what is above the diagonal is left undefined.
template <class Real>
void smallUpdate(const Real* L21, int ldL, int pivots, const Real* upper, int ldU, int rest, Real* update,
                 bool lower) {
  int j = 0;
  for (; j + 4 <= rest; j += 4)
    updateColumns<4>(L21, ldL, pivots, upper, ldU, rest, lower ? j : 0, j, update);
  for (; j < rest; ++j) updateColumns<1>(L21, ldL, pivots, upper, ldU, rest, lower ? j : 0, j, update);
}

/// The tiles of a front; one where it is not worth several threads.
class Tiles {
 public:
  Tiles(int n, int pivots, Threads& threads) : size(isLarge(n, pivots) ? 192 : n), threads_(threads) {}

  const int size;  ///< rows and columns of a tile

  /// Calls work(begin, end) for the tiles of [from, to).
  template <class Work>
  void forEach(int from, int to, const Work& work) const {
    if (from < to)
      threads_.forEach((to - from + size - 1) / size,
                       [&](int t) { work(from + size * t, std::min(from + size * (t + 1), to)); });
  }
  /// Calls work(row, rowEnd, column, columnEnd) for the tiles of rows and columns [from, to); with `lower`,
  /// for those on and below the diagonal.
  template <class Work>
  void forEachPair(int from, int to, bool lower, const Work& work) const {
    std::vector<std::pair<int, int>> tiles;
    for (int j = from; j < to; j += size)
      for (int i = lower ? j : from; i < to; i += size) tiles.emplace_back(i, j);
    if (!tiles.empty())
      threads_.forEach(static_cast<int>(tiles.size()), [&](int t) {
        const auto [i, j] = tiles[t];
        work(i, std::min(i + size, to), j, std::min(j + size, to));
      });
  }

 private:
  Threads& threads_;
};

/// Rows [i, i1) and columns [j, j1) of C = beta C - A A', on and below the diagonal.
template <class Real>
void subtractSquare(const Real* A, int ldA, int inner, Real beta, Real* C, int ldC, int i, int i1, int j,
                    int j1) {
  Real* target = C + static_cast<size_t>(ldC) * j + i;
  if (i == j) squared(j1 - j, inner, A + j, ldA, beta, target, ldC);
  const int below = std::max(i, j1);
  if (below < i1) product(i1 - below, j1 - j, inner, A + below, A + j, ldA, beta, target + (below - i), ldC);
}

/// L11.
template <class Real>
bool tiledCholesky(Real* panel, int n, int pivots, const Tiles& tiles) {
  for (int k = 0; k < pivots; k += tiles.size) {
    stopIfInterrupted();
    const int next = std::min(k + tiles.size, pivots);
    const int width = next - k;
    Real* diagonal = panel + static_cast<size_t>(n) * k + k;
    if (!cholesky(width, diagonal, n)) return false;
    tiles.forEach(next, pivots,
                  [&](int i, int i1) { solveRight(i1 - i, width, diagonal, n, diagonal + (i - k), n); });
    tiles.forEachPair(next, pivots, true, [&](int i, int i1, int j, int j1) {
      subtractSquare<Real>(panel + static_cast<size_t>(n) * k, n, width, 1, panel, n, i, i1, j, j1);
    });
  }
  return true;
}

/// L11 and U11, rows interchanged.
bool tiledLU(double* panel, int n, int pivots, int* interchange, const Tiles& tiles) {
  const auto at = [&](int i, int j) { return panel + static_cast<size_t>(n) * j + i; };
  for (int k = 0; k < pivots; k += tiles.size) {
    stopIfInterrupted();
    const int next = std::min(k + tiles.size, pivots);
    const int width = next - k;
    const int height = pivots - k;
    int info = 0;
    dgetrf_(&height, &width, at(k, k), &n, interchange + k, &info);
    if (info != 0) return false;
    const int first = 1;
    const int step = 1;
    const auto swap = [&](int j, int j1) {
      const int columns = j1 - j;
      dlaswp_(&columns, at(k, j), &n, &first, &width, interchange + k, &step);
    };
    tiles.forEach(0, k, swap);
    tiles.forEach(next, pivots, [&](int j, int j1) {
      swap(j, j1);
      cblas_dtrsm(CblasColMajor, CblasLeft, CblasLower, CblasNoTrans, CblasUnit, width, j1 - j, 1, at(k, k),
                  n, at(k, j), n);
    });
    tiles.forEachPair(next, pivots, false, [&](int i, int i1, int j, int j1) {
      cblas_dgemm(CblasColMajor, CblasNoTrans, CblasNoTrans, i1 - i, j1 - j, width, -1, at(i, k), n, at(k, j),
                  n, 1, at(i, j), n);
    });
    for (int i = k; i < next; ++i) interchange[i] += k;
  }
  return true;
}

}  // namespace

bool isLarge(int n, int pivots) {
  constexpr double least = 2e7;  // multiplications worth the locks of their tiles
  return static_cast<double>(pivots) * n * n > least;
}

template <class Real>
bool partialCholesky(Real* panel, int n, int pivots, std::type_identity_t<Real>* update, Threads& threads) {
  const int rest = n - pivots;
  Real* L21 = panel + pivots;
  if (!isSmall(n, pivots)) {
    const Tiles tiles(n, pivots, threads);
    if (!tiledCholesky(panel, n, pivots, tiles) || !finiteDiagonal(panel, n, pivots)) return false;
    tiles.forEach(0, rest, [&](int i, int i1) { solveRight(i1 - i, pivots, panel, n, L21 + i, n); });
    tiles.forEachPair(0, rest, true, [&](int i, int i1, int j, int j1) {
      subtractSquare<Real>(L21, n, pivots, 0, update, rest, i, i1, j, j1);
    });
    return true;
  }
  for (int k = 0; k < pivots; ++k) {
    Real* pivot = panel + static_cast<size_t>(n) * k;
    if (!(pivot[k] > 0) || !std::isfinite(pivot[k])) return false;
    pivot[k] = std::sqrt(pivot[k]);
    const Real inverse = 1 / pivot[k];
    for (int i = k + 1; i < n; ++i) pivot[i] *= inverse;
    for (int j = k + 1; j < pivots; ++j) {
      Real* target = panel + static_cast<size_t>(n) * j;
      const Real factor = pivot[j];
      for (int i = j; i < n; ++i) target[i] -= factor * pivot[i];
    }
  }
  smallUpdate<Real>(L21, n, pivots, L21, n, rest, update, true);
  return true;
}

bool partialLU(double* panel, int n, int pivots, double* upper, double* update, int* interchange,
               Threads& threads) {
  const int rest = n - pivots;
  double* L21 = panel + pivots;
  if (!isSmall(n, pivots)) {
    const Tiles tiles(n, pivots, threads);
    const bool regular = tiledLU(panel, n, pivots, interchange, tiles);
    for (int k = 0; k < pivots; ++k) --interchange[k];
    if (!regular || !finiteDiagonal(panel, n, pivots)) return false;
    tiles.forEach(0, rest, [&](int i, int i1) {
      swapColumns(upper + i, rest, i1 - i, interchange, pivots);
      cblas_dtrsm(CblasColMajor, CblasRight, CblasLower, CblasTrans, CblasUnit, i1 - i, pivots, 1, panel, n,
                  upper + i, rest);
      cblas_dtrsm(CblasColMajor, CblasRight, CblasUpper, CblasNoTrans, CblasNonUnit, i1 - i, pivots, 1, panel,
                  n, L21 + i, n);
    });
    tiles.forEachPair(0, rest, false, [&](int i, int i1, int j, int j1) {
      cblas_dgemm(CblasColMajor, CblasNoTrans, CblasTrans, i1 - i, j1 - j, pivots, -1, L21 + i, n, upper + j,
                  rest, 0, update + static_cast<size_t>(rest) * j + i, rest);
    });
    return true;
  }
  for (int k = 0; k < pivots; ++k) {
    double* pivot = panel + static_cast<size_t>(n) * k;
    int best = k;
    for (int i = k + 1; i < pivots; ++i)
      if (std::abs(pivot[i]) > std::abs(pivot[best])) best = i;
    interchange[k] = best;
    if (best != k)
      for (int j = 0; j < pivots; ++j)
        std::swap(panel[static_cast<size_t>(n) * j + k], panel[static_cast<size_t>(n) * j + best]);
    if (pivot[k] == 0 || !std::isfinite(pivot[k])) return false;
    const double inverse = 1 / pivot[k];
    for (int i = k + 1; i < n; ++i) pivot[i] *= inverse;
    for (int j = k + 1; j < pivots; ++j) {
      double* target = panel + static_cast<size_t>(n) * j;
      const double factor = target[k];
      for (int i = k + 1; i < n; ++i) target[i] -= factor * pivot[i];
    }
  }
  swapColumns(upper, rest, rest, interchange, pivots);
  for (int k = 0; k < pivots; ++k)
    for (int j = k + 1; j < pivots; ++j) {
      const double factor = panel[static_cast<size_t>(n) * k + j];
      const double* from = upper + static_cast<size_t>(rest) * k;
      double* to = upper + static_cast<size_t>(rest) * j;
      for (int i = 0; i < rest; ++i) to[i] -= factor * from[i];
    }
  smallUpdate(L21, n, pivots, upper, rest, rest, update, false);
  return true;
}

void swapRows(double* x, const int* interchange, int n) {
  for (int k = 0; k < n; ++k) std::swap(x[k], x[interchange[k]]);
}

template <class Real>
void solveLower(const Real* L, int ld, int n, bool unit, Real* x) {
  if (n > smallPivots) return solveVector(CblasNoTrans, unit ? CblasUnit : CblasNonUnit, n, L, ld, x);
  for (int k = 0; k < n; ++k, L += ld) {
    if (!unit) x[k] /= L[k];
    for (int i = k + 1; i < n; ++i) x[i] -= L[i] * x[k];
  }
}

template <class Real>
void solveLowerTransposed(const Real* L, int ld, int n, Real* x) {
  if (n > smallPivots) return solveVector(CblasTrans, CblasNonUnit, n, L, ld, x);
  for (int k = n; k-- > 0;) {
    const Real* column = L + static_cast<size_t>(ld) * k;
    for (int i = k + 1; i < n; ++i) x[k] -= column[i] * x[i];
    x[k] /= column[k];
  }
}

void solveUpper(const double* U, int ld, int n, double* x) {
  if (n > smallPivots) {
    cblas_dtrsv(CblasColMajor, CblasUpper, CblasNoTrans, CblasNonUnit, n, U, ld, x, 1);
    return;
  }
  for (int k = n; k-- > 0;) {
    const double* column = U + static_cast<size_t>(ld) * k;
    x[k] /= column[k];
    for (int i = 0; i < k; ++i) x[i] -= column[i] * x[k];
  }
}

template <class Real>
void multiply(const Real* A, int ld, int rows, int columns, const Real* x, Real* y) {
  if (rows == 0) return;
  if (!isSmall(rows, columns)) return timesVector(CblasNoTrans, rows, columns, 1, A, ld, x, 0, y);
  for (int i = 0; i < rows; ++i) y[i] = A[i] * x[0];
  for (int k = 1; k < columns; ++k) {
    const Real* column = A + static_cast<size_t>(ld) * k;
    for (int i = 0; i < rows; ++i) y[i] += column[i] * x[k];
  }
}

template <class Real>
void subtractTransposed(const Real* A, int ld, int rows, int columns, const Real* x, Real* y) {
  if (rows == 0) return;
  if (!isSmall(rows, columns)) return timesVector(CblasTrans, rows, columns, -1, A, ld, x, 1, y);
  for (int k = 0; k < columns; ++k) y[k] -= dot(A + static_cast<size_t>(ld) * k, x, rows);
}

template bool partialCholesky(double*, int, int, double*, Threads&);
template void solveLower(const double*, int, int, bool, double*);
template void solveLowerTransposed(const double*, int, int, double*);
template void multiply(const double*, int, int, int, const double*, double*);
template void subtractTransposed(const double*, int, int, int, const double*, double*);
template bool partialCholesky(float*, int, int, float*, Threads&);
template void solveLower(const float*, int, int, bool, float*);
template void solveLowerTransposed(const float*, int, int, float*);
template void multiply(const float*, int, int, int, const float*, float*);
template void subtractTransposed(const float*, int, int, int, const float*, float*);

}  // namespace mortier::dense
