#include "solver/dense_factor.h"

#include "base/parallel.h"
#include "linear/blas.h"
#include "linear/dense_kernels.h"

extern "C" {
void dpotrs_(const char* uplo, const int* n, const int* columns, const double* a, const int* lda, double* b,
             const int* ldb, int* info);
void dgetrs_(const char* transposed, const int* n, const int* columns, const double* a, const int* lda,
             const int* interchange, double* b, const int* ldb, int* info);
}

namespace mortier {

bool DenseFactor::factorise(Matrix&& matrix, bool symmetric) {
  symmetric_ = symmetric;
  factor_ = std::move(matrix);
  leastPivot_ = factor_.rows() == 0 ? 1 : 0;
  if (factor_.rows() == 0) return true;
  const auto n = static_cast<int>(factor_.rows());
  dense::useOneThread();
  Threads& threads = Threads::none();
  if (symmetric) {
    const Vector before = factor_.diagonal();
    if (!dense::partialCholesky(factor_.data(), n, n, nullptr, threads)) return false;
    leastPivot_ = (factor_.diagonal().array().square() / before.array()).minCoeff();
    return true;
  }
  const Vector before = factor_.colwise().lpNorm<Eigen::Infinity>();
  interchange_.resize(n);
  if (!dense::partialLU(factor_.data(), n, n, nullptr, nullptr, interchange_.data(), threads)) return false;
  interchange_.array() += 1;
  leastPivot_ = (factor_.diagonal().cwiseAbs().array() / before.array()).minCoeff();
  return leastPivot_ > 0;
}

int DenseFactor::sign() const {
  if (symmetric_) return 1;
  bool negative = false;
  for (Eigen::Index k = 0; k < factor_.rows(); ++k)
    negative = negative != ((factor_(k, k) < 0) != (interchange_[k] != k + 1));
  return negative ? -1 : 1;
}

void DenseFactor::solve(Matrix& x) const {
  const auto n = static_cast<int>(factor_.rows());
  const auto columns = static_cast<int>(x.cols());
  int info = 0;
  if (n == 0 || columns == 0) return;
  if (!symmetric_) {
    dgetrs_("N", &n, &columns, factor_.data(), &n, interchange_.data(), x.data(), &n, &info);
  } else if (columns > 1) {
    dpotrs_("L", &n, &columns, factor_.data(), &n, x.data(), &n, &info);
  } else {  // which dpotrs treats as many
    dense::solveLower(factor_.data(), n, n, false, x.data());
    dense::solveLowerTransposed(factor_.data(), n, n, x.data());
  }
}

}  // namespace mortier
