// Sums of products in twice the working precision: residuals of systems whose solutions cancel.
#pragma once

#include "base/two_part_vector.h"

namespace mortier {

class TwoPartSums {
 public:
  explicit TwoPartSums(Vector start) : high_(std::move(start)), low_(Vector::Zero(high_.size())) {}

  /// += A x
  void add(const Eigen::Ref<const Matrix>& A, const TwoPartVector& x) {
    for (Eigen::Index j = 0; j < A.cols(); ++j) {
      if (x.high[j] == 0 && x.low[j] == 0) continue;
      for (Eigen::Index i = 0; i < A.rows(); ++i) {
        const DoubleDouble product = DoubleDouble::product(A(i, j), x.high[j]);
        const DoubleDouble sum = DoubleDouble::sum(high_[i], product.high);
        high_[i] = sum.high;
        low_[i] += sum.low + (product.low + A(i, j) * x.low[j]);
      }
    }
  }

  [[nodiscard]] Vector value() const { return high_ + low_; }

 private:
  Vector high_;
  Vector low_;
};

}  // namespace mortier
