// In-place factorisation of a dense matrix: Cholesky if it is symmetric, else LU with row interchanges
// (linear/dense_kernels.h); interruptions are checked between the blocks of a large matrix.
#pragma once

#include "base/types.h"

namespace mortier {

class DenseFactor {
 public:
  /// Takes the matrix over; of a symmetric one only the lower triangle is read.
  /// \returns false where it is not positive definite, or a pivot of LU vanishes. \throws Interrupted
  bool factorise(Matrix&& matrix, bool symmetric);
  /// Gives the memory back.
  void clear() { factor_.resize(0, 0); }
  /// x becomes the solution for the right-hand sides x (rows x any).
  void solve(Matrix& x) const;
  /// Least pivot over what stood in its place before elimination: over the diagonal,
  /// or the largest entry of the column.
  [[nodiscard]] double leastPivot() const { return leastPivot_; }
  /// Of the determinant.
  [[nodiscard]] int sign() const;
  [[nodiscard]] Eigen::Index rows() const { return factor_.rows(); }

 private:
  bool symmetric_ = true;
  Matrix factor_;
  Eigen::VectorXi interchange_;  ///< by columns: the row that was exchanged with the pivot's, from 1
  double leastPivot_ = 0;
};

}  // namespace mortier
