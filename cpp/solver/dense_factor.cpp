#include "solver/dense_factor.h"

#include <Eigen/Cholesky>
#include <Eigen/LU>
#include <utility>

namespace mortier {

bool DenseFactor::factorise(Matrix&& matrix, bool symmetric) {
  symmetric_ = symmetric;
  factor_ = std::move(matrix);
  leastPivot_ = 1;
  if (factor_.rows() == 0) return true;
  Eigen::Ref<Matrix> inPlace(factor_);
  if (symmetric) {
    const Vector before = factor_.diagonal();
    const Eigen::LLT<Eigen::Ref<Matrix>> cholesky(inPlace);
    leastPivot_ = (factor_.diagonal().array().square() / before.array()).minCoeff();
    return cholesky.info() == Eigen::Success;
  }
  const Vector before = factor_.colwise().lpNorm<Eigen::Infinity>();
  const Eigen::PartialPivLU<Eigen::Ref<Matrix>> lu(inPlace);
  interchange_ = lu.permutationP().indices();
  leastPivot_ = (factor_.diagonal().cwiseAbs().array() / before.array()).minCoeff();
  return leastPivot_ > 0;
}

void DenseFactor::solve(Matrix& x) const {
  if (factor_.rows() == 0) return;
  if (symmetric_) {
    factor_.triangularView<Eigen::Lower>().solveInPlace(x);
    factor_.triangularView<Eigen::Lower>().adjoint().solveInPlace(x);
    return;
  }
  x = Eigen::PermutationMatrix<Eigen::Dynamic>(interchange_) * x;
  factor_.triangularView<Eigen::UnitLower>().solveInPlace(x);
  factor_.triangularView<Eigen::Upper>().solveInPlace(x);
}

}  // namespace mortier
