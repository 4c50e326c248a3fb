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

double* column(double* F, int n, int j) {
  return F + static_cast<size_t>(n) * j;
}

}  // namespace

bool partialCholesky(double* F, int n, int pivots) {
  const int rest = n - pivots;
  if (!isSmall(n, pivots)) {
    int info = 0;
    dpotrf_("L", &pivots, F, &n, &info);
    if (info != 0 || !std::isfinite(column(F, n, pivots - 1)[pivots - 1])) return false;
    if (rest == 0) return true;
    double* L21 = F + pivots;
    cblas_dtrsm(CblasColMajor, CblasRight, CblasLower, CblasTrans, CblasNonUnit, rest, pivots, 1, F, n, L21,
                n);
    cblas_dsyrk(CblasColMajor, CblasLower, CblasNoTrans, rest, pivots, -1, L21, n, 1,
                column(F, n, pivots) + pivots, n);
    return true;
  }
  for (int k = 0; k < pivots; ++k) {
    double* pivot = column(F, n, k);
    if (!(pivot[k] > 0) || !std::isfinite(pivot[k])) return false;
    pivot[k] = std::sqrt(pivot[k]);
    const double inverse = 1 / pivot[k];
    for (int i = k + 1; i < n; ++i) pivot[i] *= inverse;
    for (int j = k + 1; j < n; ++j) {
      double* target = column(F, n, j);
      const double factor = pivot[j];
      for (int i = j; i < n; ++i) target[i] -= factor * pivot[i];
    }
  }
  return true;
}

bool partialLU(double* F, int n, int pivots, int* interchange) {
  const int rest = n - pivots;
  if (!isSmall(n, pivots)) {
    int info = 0;
    dgetrf_(&pivots, &pivots, F, &n, interchange, &info);
    for (int k = 0; k < pivots; ++k) --interchange[k];
    if (info != 0 || !std::isfinite(column(F, n, pivots - 1)[pivots - 1])) return false;
    if (rest == 0) return true;
    double* L21 = F + pivots;
    double* U12 = column(F, n, pivots);
    for (int j = 0; j < rest; ++j) swapRows(U12 + static_cast<size_t>(n) * j, interchange, pivots);
    cblas_dtrsm(CblasColMajor, CblasLeft, CblasLower, CblasNoTrans, CblasUnit, pivots, rest, 1, F, n, U12, n);
    cblas_dtrsm(CblasColMajor, CblasRight, CblasUpper, CblasNoTrans, CblasNonUnit, rest, pivots, 1, F, n, L21,
                n);
    cblas_dgemm(CblasColMajor, CblasNoTrans, CblasNoTrans, rest, rest, pivots, -1, L21, n, U12, n, 1,
                U12 + pivots, n);
    return true;
  }
  for (int k = 0; k < pivots; ++k) {
    double* pivot = column(F, n, k);
    int best = k;
    for (int i = k + 1; i < pivots; ++i)
      if (std::abs(pivot[i]) > std::abs(pivot[best])) best = i;
    interchange[k] = best;
    if (best != k)
      for (int j = 0; j < n; ++j) std::swap(column(F, n, j)[k], column(F, n, j)[best]);
    if (pivot[k] == 0 || !std::isfinite(pivot[k])) return false;
    const double inverse = 1 / pivot[k];
    for (int i = k + 1; i < n; ++i) pivot[i] *= inverse;
    for (int j = k + 1; j < n; ++j) {
      double* target = column(F, n, j);
      const double factor = target[k];
      for (int i = k + 1; i < n; ++i) target[i] -= factor * pivot[i];
    }
  }
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
