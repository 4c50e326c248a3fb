// BLAS and LAPACK in both precisions under one name each; matrices by columns, triangles lower ones.
#pragma once

#include <cblas.h>

extern "C" {
void spotrf_(const char* uplo, const int* n, float* a, const int* lda, int* info);
void dpotrf_(const char* uplo, const int* n, double* a, const int* lda, int* info);
}

namespace mortier::dense {

/// Lets BLAS use one thread: bodies, pieces of the factorisation and tiles of large fronts run in parallel.
void useOneThread();

/// And ends the threads that BLAS began when it was loaded, one per core: they wait busily for a while. For a
/// program that nothing else in its process calls BLAS for.
void endThreadsOfBlas();

/// L of the leading block. \returns whether it is positive definite
inline bool cholesky(int n, float* A, int ld) {
  int info = 0;
  spotrf_("L", &n, A, &ld, &info);
  return info == 0;
}
inline bool cholesky(int n, double* A, int ld) {
  int info = 0;
  dpotrf_("L", &n, A, &ld, &info);
  return info == 0;
}

/// B = B L^-T.
inline void solveRight(int rows, int n, const float* L, int ldL, float* B, int ldB) {
  cblas_strsm(CblasColMajor, CblasRight, CblasLower, CblasTrans, CblasNonUnit, rows, n, 1, L, ldL, B, ldB);
}
inline void solveRight(int rows, int n, const double* L, int ldL, double* B, int ldB) {
  cblas_dtrsm(CblasColMajor, CblasRight, CblasLower, CblasTrans, CblasNonUnit, rows, n, 1, L, ldL, B, ldB);
}

/// C = beta C - A A', its lower triangle.
inline void squared(int n, int inner, const float* A, int ldA, float beta, float* C, int ldC) {
  cblas_ssyrk(CblasColMajor, CblasLower, CblasNoTrans, n, inner, -1, A, ldA, beta, C, ldC);
}
inline void squared(int n, int inner, const double* A, int ldA, double beta, double* C, int ldC) {
  cblas_dsyrk(CblasColMajor, CblasLower, CblasNoTrans, n, inner, -1, A, ldA, beta, C, ldC);
}

/// C = beta C - A B', A and B with one leading dimension.
inline void product(int rows, int columns, int inner, const float* A, const float* B, int ld, float beta,
                    float* C, int ldC) {
  cblas_sgemm(CblasColMajor, CblasNoTrans, CblasTrans, rows, columns, inner, -1, A, ld, B, ld, beta, C, ldC);
}
inline void product(int rows, int columns, int inner, const double* A, const double* B, int ld, double beta,
                    double* C, int ldC) {
  cblas_dgemm(CblasColMajor, CblasNoTrans, CblasTrans, rows, columns, inner, -1, A, ld, B, ld, beta, C, ldC);
}

/// x = L^-1 x, or L^-T x.
inline void solveVector(CBLAS_TRANSPOSE transposed, CBLAS_DIAG diagonal, int n, const float* L, int ld,
                        float* x) {
  cblas_strsv(CblasColMajor, CblasLower, transposed, diagonal, n, L, ld, x, 1);
}
inline void solveVector(CBLAS_TRANSPOSE transposed, CBLAS_DIAG diagonal, int n, const double* L, int ld,
                        double* x) {
  cblas_dtrsv(CblasColMajor, CblasLower, transposed, diagonal, n, L, ld, x, 1);
}

/// y = alpha A x + beta y, or with A'.
inline void timesVector(CBLAS_TRANSPOSE transposed, int rows, int columns, float alpha, const float* A,
                        int ld, const float* x, float beta, float* y) {
  cblas_sgemv(CblasColMajor, transposed, rows, columns, alpha, A, ld, x, 1, beta, y, 1);
}
inline void timesVector(CBLAS_TRANSPOSE transposed, int rows, int columns, double alpha, const double* A,
                        int ld, const double* x, double beta, double* y) {
  cblas_dgemv(CblasColMajor, transposed, rows, columns, alpha, A, ld, x, 1, beta, y, 1);
}

}  // namespace mortier::dense
