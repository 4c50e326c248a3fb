// Enclosures of a function along a line, and of its derivatives: interval arithmetic (Moore, Interval
// Analysis, 1966) on Taylor coefficients. The coefficients of u v, u/v, exp u ... follow from those of u and
// v by recurrences that hold at every point, so with intervals they enclose the coefficients at all points of
// a piece of the line. Bounds are rounded outwards.
#pragma once

#include <array>
#include <cmath>
#include <limits>

#include "base/types.h"

namespace mortier {

struct Interval {
  double least = 0;
  double largest = 0;

  static Interval anything() { return {-infinity, infinity}; }
  [[nodiscard]] bool holds(double x) const { return least <= x && x <= largest; }
  [[nodiscard]] bool isZero() const { return least == 0 && largest == 0; }
  [[nodiscard]] bool finite() const { return std::isfinite(least) && std::isfinite(largest); }
  [[nodiscard]] double magnitude() const { return std::max(std::abs(least), std::abs(largest)); }
};

Interval operator-(const Interval& a);
Interval operator+(const Interval& a, const Interval& b);
Interval operator-(const Interval& a, const Interval& b);
Interval operator*(const Interval& a, const Interval& b);
Interval operator/(const Interval& a, const Interval& b);
Interval hull(const Interval& a, const Interval& b);

/// f^(k)/k! for k = 0 ... at all points of a piece.
struct Taylor {
  static constexpr int order = 8;
  std::array<Interval, order + 1> c{};

  static Taylor constant(const Interval& value) {
    Taylor result;
    result.c[0] = value;
    return result;
  }
  /// A function of which but its values are known.
  static Taylor within(const Interval& value) {
    Taylor result;
    result.c.fill(Interval::anything());
    result.c[0] = value;
    return result;
  }
  /// first + s along, s in a piece.
  static Taylor linear(double first, double along, const Interval& piece) {
    Taylor result;
    result.c[0] = Interval{first, first} + Interval{along, along} * piece;
    result.c[1] = {along, along};
    return result;
  }
};

Taylor operator-(const Taylor& u);
Taylor operator+(const Taylor& u, const Taylor& v);
Taylor operator-(const Taylor& u, const Taylor& v);
Taylor operator*(const Taylor& u, const Taylor& v);
Taylor operator/(const Taylor& u, const Taylor& v);
Taylor exp(const Taylor& u);
Taylor log(const Taylor& u);
/// u^a where u is positive.
Taylor pow(const Taylor& u, double a);
/// sin u and cos u.
std::array<Taylor, 2> sinAndCos(const Taylor& u);
/// A function g of u: g' = 1/q(u), q as a series, and its values.
Taylor integrated(const Taylor& u, const Taylor& q, const Interval& values);

}  // namespace mortier
