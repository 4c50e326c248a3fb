// A vector carried as an unevaluated sum of two: a small change of large entries is not rounded to their
// size.
#pragma once

#include <cmath>

#include "base/types.h"

namespace mortier {

// Sums and products in twice the working precision (Dekker 1971, Knuth 1969). Needs IEEE arithmetic: no
// -ffast-math.

/// An unevaluated sum high + low.
struct DoubleDouble {
  double high = 0;
  double low = 0;

  [[nodiscard]] double value() const { return high + low; }

  static DoubleDouble sum(double a, double b) {
    const double s = a + b;
    const double t = s - a;
    return {s, (a - (s - t)) + (b - t)};
  }

  static DoubleDouble product(double a, double b) {
    const double p = a * b;
    return {p, std::fma(a, b, -p)};
  }
  static DoubleDouble product(double a, const DoubleDouble& b) {
    DoubleDouble p = product(a, b.high);
    p.low += a * b.low;
    return p;
  }

  DoubleDouble& operator+=(const DoubleDouble& b) {
    const DoubleDouble s = sum(high, b.high);
    const double rest = s.low + (low + b.low);
    high = s.high + rest;
    low = rest - (high - s.high);
    return *this;
  }
};

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

// Sums of products in twice the working precision: residuals of systems whose solutions cancel.

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
