// A vector carried as an unevaluated sum of two: a small change of large entries is not rounded to their
// size.
#pragma once

#include "base/double_double.h"
#include "base/types.h"

namespace mortier {

struct TwoPartVector {
  Vector high;
  Vector low;

  static TwoPartVector zero(Eigen::Index size) { return {Vector::Zero(size), Vector::Zero(size)}; }

  [[nodiscard]] Vector value() const { return high + low; }

  TwoPartVector& operator+=(const Vector& change) {
    for (Eigen::Index i = 0; i < change.size(); ++i) {
      const DoubleDouble sum = DoubleDouble::sum(high[i], change[i]);
      high[i] = sum.high;
      low[i] += sum.low;
    }
    return *this;
  }

  /// The component of the vector at rows i, i + 1 along a unit vector; the one across it stays.
  void setAlong(Eigen::Index i, const Point& direction, double value) {
    high.segment<2>(i) += (value - direction.dot(high.segment<2>(i))) * direction;
    low.segment<2>(i) -= direction.dot(low.segment<2>(i)) * direction;
  }
  void set(Eigen::Index i, double value) {
    high[i] = value;
    low[i] = 0;
  }

  /// The difference, rounded once.
  [[nodiscard]] Vector minus(const TwoPartVector& other) const {
    return (high - other.high) + (low - other.low);
  }
};

inline TwoPartVector operator*(double factor, const TwoPartVector& v) {
  return {factor * v.high, factor * v.low};
}

}  // namespace mortier
