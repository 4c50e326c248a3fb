// Sums and products in twice the working precision (Dekker 1971, Knuth 1969). Needs IEEE arithmetic: no
// -ffast-math.
#pragma once

#include <cmath>

namespace mortier {

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

  DoubleDouble& operator+=(const DoubleDouble& b) {
    const DoubleDouble s = sum(high, b.high);
    const double rest = s.low + (low + b.low);
    high = s.high + rest;
    low = rest - (high - s.high);
    return *this;
  }
};

}  // namespace mortier
