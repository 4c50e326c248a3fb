#include "linear/dense_kernels.h"

#include <cblas.h>

#include <algorithm>
#include <cmath>
#include <cstddef>

extern "C" {
void dpotrf_(const char* uplo, const int* n, double* a, const int* lda, int* info);
void dgetrf_(const int* m, const int* n, double* a, const int* lda, int* ipiv, int* info);
}

namespace mortier::dense {
namespace {

/// Below this many pivots a call of BLAS costs more than the loops it saves.
constexpr int smallPivots = 12;
constexpr int smallRows = 96;

bool isSmall(int n, int pivots) {
  return pivots <= smallPivots && n <= smallRows;
}

/// NaN anywhere in a factorised block has reached its diagonal.
bool finiteDiagonal(const double* panel, int n, int pivots) {
  for (int k = 0; k < pivots; ++k)
    if (!std::isfinite(panel[static_cast<size_t>(n) * k + k])) return false;
  return true;
}

/// update -= L21 U12 by columns of U12, entry (k, j) at upper[stepK k + stepJ j]; below the diagonal only if
/// `lower`.
void smallUpdate(const double* L21, int n, int pivots, const double* upper, int stepK, int stepJ,
                 double* update, bool lower) {
  const int rest = n - pivots;
  for (int j = 0; j < rest; ++j) {
    double* target = update + static_cast<size_t>(rest) * j;
    const double* u = upper + static_cast<size_t>(stepJ) * j;
    const int begin = lower ? j : 0;
    int k = 0;
    for (; k + 1 < pivots; k += 2) {
      const double u0 = u[static_cast<size_t>(stepK) * k];
      const double u1 = u[static_cast<size_t>(stepK) * (k + 1)];
      const double* L0 = L21 + static_cast<size_t>(n) * k;
      const double* L1 = L0 + n;
      for (int i = begin; i < rest; ++i) target[i] -= L0[i] * u0 + L1[i] * u1;
    }
    if (k < pivots) {
      const double u0 = u[static_cast<size_t>(stepK) * k];
      const double* L0 = L21 + static_cast<size_t>(n) * k;
      for (int i = begin; i < rest; ++i) target[i] -= L0[i] * u0;
    }
  }
}

}  // namespace

void useOneThread() {
  openblas_set_num_threads(1);
}

bool partialCholesky(double* panel, int n, int pivots, double* update) {
  const int rest = n - pivots;
  double* L21 = panel + pivots;
  if (!isSmall(n, pivots)) {
    int info = 0;
    dpotrf_("L", &pivots, panel, &n, &info);
    if (info != 0 || !finiteDiagonal(panel, n, pivots)) return false;
    if (rest == 0) return true;
    cblas_dtrsm(CblasColMajor, CblasRight, CblasLower, CblasTrans, CblasNonUnit, rest, pivots, 1, panel, n,
                L21, n);
    cblas_dsyrk(CblasColMajor, CblasLower, CblasNoTrans, rest, pivots, -1, L21, n, 1, update, rest);
    return true;
  }
  for (int k = 0; k < pivots; ++k) {
    double* pivot = panel + static_cast<size_t>(n) * k;
    if (!(pivot[k] > 0) || !std::isfinite(pivot[k])) return false;
    pivot[k] = std::sqrt(pivot[k]);
    const double inverse = 1 / pivot[k];
    for (int i = k + 1; i < n; ++i) pivot[i] *= inverse;
    for (int j = k + 1; j < pivots; ++j) {
      double* target = panel + static_cast<size_t>(n) * j;
      const double factor = pivot[j];
      for (int i = j; i < n; ++i) target[i] -= factor * pivot[i];
    }
  }
  smallUpdate(L21, n, pivots, L21, n, 1, update, true);
  return true;
}

bool partialLU(double* panel, int n, int pivots, double* upper, double* update, int* interchange) {
  const int rest = n - pivots;
  double* L21 = panel + pivots;
  if (!isSmall(n, pivots)) {
    int info = 0;
    dgetrf_(&pivots, &pivots, panel, &n, interchange, &info);
    for (int k = 0; k < pivots; ++k) --interchange[k];
    if (info != 0 || !finiteDiagonal(panel, n, pivots)) return false;
    if (rest == 0) return true;
    for (int j = 0; j < rest; ++j) swapRows(upper + static_cast<size_t>(pivots) * j, interchange, pivots);
    cblas_dtrsm(CblasColMajor, CblasLeft, CblasLower, CblasNoTrans, CblasUnit, pivots, rest, 1, panel, n,
                upper, pivots);
    cblas_dtrsm(CblasColMajor, CblasRight, CblasUpper, CblasNoTrans, CblasNonUnit, rest, pivots, 1, panel, n,
                L21, n);
    cblas_dgemm(CblasColMajor, CblasNoTrans, CblasNoTrans, rest, rest, pivots, -1, L21, n, upper, pivots, 1,
                update, rest);
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
  for (int j = 0; j < rest; ++j) {
    double* u = upper + static_cast<size_t>(pivots) * j;
    swapRows(u, interchange, pivots);
    for (int k = 0; k < pivots; ++k)
      for (int i = k + 1; i < pivots; ++i) u[i] -= panel[static_cast<size_t>(n) * k + i] * u[k];
  }
  smallUpdate(L21, n, pivots, upper, 1, pivots, update, false);
  return true;
}

void swapRows(double* x, const int* interchange, int n) {
  for (int k = 0; k < n; ++k) std::swap(x[k], x[interchange[k]]);
}

void solveLower(const double* L, int ld, int n, bool unit, double* x) {
  cblas_dtrsv(CblasColMajor, CblasLower, CblasNoTrans, unit ? CblasUnit : CblasNonUnit, n, L, ld, x, 1);
}

void solveLowerTransposed(const double* L, int ld, int n, double* x) {
  cblas_dtrsv(CblasColMajor, CblasLower, CblasTrans, CblasNonUnit, n, L, ld, x, 1);
}

void solveUpper(const double* U, int ld, int n, double* x) {
  cblas_dtrsv(CblasColMajor, CblasUpper, CblasNoTrans, CblasNonUnit, n, U, ld, x, 1);
}

void multiply(const double* A, int ld, int rows, int columns, const double* x, double* y) {
  if (rows > 0) cblas_dgemv(CblasColMajor, CblasNoTrans, rows, columns, 1, A, ld, x, 1, 0, y, 1);
}

void subtract(const double* A, int ld, int rows, int columns, const double* x, double* y) {
  if (columns > 0) cblas_dgemv(CblasColMajor, CblasNoTrans, rows, columns, -1, A, ld, x, 1, 1, y, 1);
}

void subtractTransposed(const double* A, int ld, int rows, int columns, const double* x, double* y) {
  if (rows > 0) cblas_dgemv(CblasColMajor, CblasTrans, rows, columns, -1, A, ld, x, 1, 1, y, 1);
}

}  // namespace mortier::dense
