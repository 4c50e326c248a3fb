// Dense kernels of the multifrontal factorisation: loops for the many small fronts, BLAS for the few large
// ones. Matrices are column major with leading dimension `ld`. Real: double or float.
#pragma once

#include <type_traits>

#include "base/parallel.h"

namespace mortier::dense {

/// Whether threads share the work of a front; its bits do not depend on how many they are.
bool isLarge(int n, int pivots);

/// Panel (n x pivots, lower triangle) becomes [L11; L21], update (updates x updates, lower triangle) -L21
/// L21'.
/// \returns false unless the pivot block is positive definite.
template <class Real>
bool partialCholesky(Real* panel, int n, int pivots, std::type_identity_t<Real>* update, Threads& threads);

/// Panel (n x pivots) becomes [L11\U11; L21], upper (updates x pivots) from F12' to U12', update -L21 U12;
/// the rows of the pivot block are interchanged by `interchange` (from 0). \returns false when the
/// pivot block is singular.
bool partialLU(double* panel, int n, int pivots, double* upper, double* update, int* interchange,
               Threads& threads);

/// Interchanges the first n entries of x as partialLU did.
void swapRows(double* x, const int* interchange, int n);
/// x = L^-1 x; `unit`: ones on the diagonal.
template <class Real>
void solveLower(const Real* L, int ld, int n, bool unit, Real* x);
/// x = L^-T x.
template <class Real>
void solveLowerTransposed(const Real* L, int ld, int n, Real* x);
/// x = U^-1 x.
void solveUpper(const double* U, int ld, int n, double* x);
/// y = A x, A rows x columns.
template <class Real>
void multiply(const Real* A, int ld, int rows, int columns, const Real* x, Real* y);
/// y -= A' x, A rows x columns.
template <class Real>
void subtractTransposed(const Real* A, int ld, int rows, int columns, const Real* x, Real* y);

}  // namespace mortier::dense
