// Factors of a dense matrix, made in its own memory: Cholesky's where it is symmetric, else LU with row interchanges.
#pragma once

#include "base/types.h"

namespace mortier {

class DenseFactor {
 public:
  /// Takes the matrix over; of a symmetric one only the lower triangle is read.
  /// \returns false where it is not positive definite, or a pivot of LU vanishes.
  bool factorise(Matrix&& matrix, bool symmetric);
  /// Gives the memory back.
  void clear() { factor_.resize(0, 0); }
  /// x becomes the solution for the right-hand sides x (rows x any).
  void solve(Matrix& x) const;
  /// Least pivot over what stood in its place before elimination: over the diagonal, or the largest entry of the column.
  [[nodiscard]] double leastPivot() const { return leastPivot_; }
  [[nodiscard]] Eigen::Index rows() const { return factor_.rows(); }

 private:
  bool symmetric_ = true;
  Matrix factor_;
  Eigen::VectorXi interchange_;
  double leastPivot_ = 0;
};

}  // namespace mortier
