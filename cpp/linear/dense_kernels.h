// Dense kernels of the multifrontal factorisation: loops for the many small fronts, BLAS for the few large
// ones. Matrices are column major with leading dimension `ld`.
#pragma once

namespace mortier::dense {

/// F (n x n, lower triangle) = [L11 .; L21 F22 - L21 L21']. \returns false unless F11 is positive definite.
bool partialCholesky(double* F, int n, int pivots);

/// F (n x n) = [L11\U11 U12; L21 F22 - L21 U12], rows of the pivot block interchanged as `interchange` (from
/// 0) tells. \returns false when F11 is singular.
bool partialLU(double* F, int n, int pivots, int* interchange);

void swapRows(double* x, const int* interchange, int n);
/// x = L^-1 x; `unit`: ones on the diagonal.
void solveLower(const double* L, int ld, int n, bool unit, double* x);
/// x = L^-T x.
void solveLowerTransposed(const double* L, int ld, int n, double* x);
/// x = U^-1 x.
void solveUpper(const double* U, int ld, int n, double* x);
/// y = A x, A rows x columns.
void multiply(const double* A, int ld, int rows, int columns, const double* x, double* y);
/// y -= A x.
void subtract(const double* A, int ld, int rows, int columns, const double* x, double* y);
/// y -= A' x, A rows x columns.
void subtractTransposed(const double* A, int ld, int rows, int columns, const double* x, double* y);

}  // namespace mortier::dense
