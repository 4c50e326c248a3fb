// Numbers with their derivatives (forward mode of automatic differentiation) for laws of one's own: a value
// at eight points at once and its slopes along n directions; Dual<0> is a value alone. Where a slope is 0 a
// product with it is 0 whatever the other factor, so that sqrt(s11^2) has the slope 0 at 0, not NaN.
#pragma once

#include <cmath>
#include <limits>

#include "base/lanes.h"

namespace mortier {

template <int n>
struct Dual {
  Lanes value = 0;
  std::array<Lanes, n> slope{};

  Dual() = default;
  Dual(double x) : value(x) {}
  Dual(const Lanes& x) : value(x) {}
};

/// dx * slope, 0 where the slope is.
template <int n>
void addAlong(Dual<n>& result, const Dual<n>& x, const Lanes& dx) {
  if constexpr (n > 0) {
    if (all_of(abs(dx) <= std::numeric_limits<double>::max()))
      for (int k = 0; k < n; ++k) result.slope[k] += dx * x.slope[k];
    else
      for (int k = 0; k < n; ++k) result.slope[k] += select(x.slope[k] == 0, 0, dx * x.slope[k]);
  }
}
template <int n>
Dual<n> along(const Lanes& value, const Dual<n>& x, const Lanes& dx) {
  Dual<n> result(value);
  addAlong(result, x, dx);
  return result;
}
template <int n>
Dual<n> along(const Lanes& value, const Dual<n>& x, const Lanes& dx, const Dual<n>& y, const Lanes& dy) {
  Dual<n> result = along(value, x, dx);
  addAlong(result, y, dy);
  return result;
}

/// Calls `each` for every lane's value.
template <class Each>
Lanes eachLane(const Lanes& x, Each each) {
  return Lanes([&](auto lane) { return each(static_cast<double>(x[lane])); });
}

template <int n>
Dual<n> select(const LaneMask& mask, const Dual<n>& yes, const Dual<n>& no) {
  Dual<n> result(select(mask, yes.value, no.value));
  for (int k = 0; k < n; ++k) result.slope[k] = select(mask, yes.slope[k], no.slope[k]);
  return result;
}

template <int n>
Dual<n> operator-(const Dual<n>& x) {
  return along(-x.value, x, Lanes(-1));
}
template <int n>
Dual<n> operator+(const Dual<n>& x, const Dual<n>& y) {
  Dual<n> result(x.value + y.value);
  for (int k = 0; k < n; ++k) result.slope[k] = x.slope[k] + y.slope[k];
  return result;
}
template <int n>
Dual<n> operator-(const Dual<n>& x, const Dual<n>& y) {
  Dual<n> result(x.value - y.value);
  for (int k = 0; k < n; ++k) result.slope[k] = x.slope[k] - y.slope[k];
  return result;
}
template <int n>
Dual<n> operator*(const Dual<n>& x, const Dual<n>& y) {
  return along(x.value * y.value, x, y.value, y, x.value);
}
template <int n>
Dual<n> operator/(const Dual<n>& x, const Dual<n>& y) {
  const Lanes quotient = x.value / y.value;
  return along(quotient, x, 1 / y.value, y, -quotient / y.value);
}

// With a number on either side.
template <int n>
Dual<n> operator+(const Dual<n>& x, double y) {
  return x + Dual<n>(y);
}
template <int n>
Dual<n> operator+(double x, const Dual<n>& y) {
  return Dual<n>(x) + y;
}
template <int n>
Dual<n> operator-(const Dual<n>& x, double y) {
  return x - Dual<n>(y);
}
template <int n>
Dual<n> operator-(double x, const Dual<n>& y) {
  return Dual<n>(x) - y;
}
template <int n>
Dual<n> operator*(const Dual<n>& x, double y) {
  return along(x.value * y, x, Lanes(y));
}
template <int n>
Dual<n> operator*(double x, const Dual<n>& y) {
  return y * x;
}
template <int n>
Dual<n> operator/(const Dual<n>& x, double y) {
  return along(x.value / y, x, Lanes(1 / y));
}
template <int n>
Dual<n> operator/(double x, const Dual<n>& y) {
  return Dual<n>(x) / y;
}

template <int n>
LaneMask operator<(const Dual<n>& x, const Dual<n>& y) {
  return x.value < y.value;
}
template <int n>
LaneMask operator>(const Dual<n>& x, const Dual<n>& y) {
  return y < x;
}

template <int n>
Dual<n> max(const Dual<n>& x, const Dual<n>& y) {
  return select(y < x, x, y);
}
template <int n>
Dual<n> min(const Dual<n>& x, const Dual<n>& y) {
  return select(x < y, x, y);
}
template <int n>
Dual<n> max(double x, const Dual<n>& y) {
  return max(Dual<n>(x), y);
}
template <int n>
Dual<n> min(double x, const Dual<n>& y) {
  return min(Dual<n>(x), y);
}

/// 1, 0 or -1, without slope.
template <int n>
Dual<n> sign(const Dual<n>& x) {
  return select(x.value > 0, Lanes(1), select(x.value < 0, Lanes(-1), Lanes(0)));
}
template <int n>
Dual<n> abs(const Dual<n>& x) {
  return along(abs(x.value), x, sign(x).value);
}
template <int n>
Dual<n> sqrt(const Dual<n>& x) {
  const Lanes root = sqrt(x.value);
  return along(root, x, 0.5 / root);
}
template <int n>
Dual<n> exp(const Dual<n>& x) {
  const Lanes power = exp(x.value);
  return along(power, x, power);
}
template <int n>
Dual<n> log(const Dual<n>& x) {
  return along(log(x.value), x, 1 / x.value);
}

/// x^y; whole powers and roots without logarithms.
inline Lanes power(const Lanes& x, double y) {
  constexpr int most = 64;
  if (y == 0.5) return sqrt(x);
  if (y == std::rint(y) && std::abs(y) <= most) {
    Lanes result = 1;
    Lanes square = x;
    for (int left = std::abs(static_cast<int>(y)); left > 0; left /= 2, square *= square)
      if (left % 2 == 1) result *= square;
    return y < 0 ? 1 / result : result;
  }
  return eachLane(x, [y](double each) { return std::pow(each, y); });
}
template <int n>
Dual<n> pow(const Dual<n>& x, double y) {
  const Lanes value = power(x.value, y);
  if constexpr (n == 0) return value;
  if (none_of(x.value == 0)) return along(value, x, y * value / x.value);
  return along(value, x, y * power(x.value, y - 1));
}
template <int n>
Dual<n> pow(const Dual<n>& x, const Dual<n>& y) {
  const auto raise = [](const Lanes& a, const Lanes& b) {
    return Lanes(
        [&](auto lane) { return std::pow(static_cast<double>(a[lane]), static_cast<double>(b[lane])); });
  };
  const Lanes value = raise(x.value, y.value);
  if constexpr (n == 0) return value;
  return along(value, x, y.value * raise(x.value, y.value - 1), y, log(x.value) * value);
}

/// A function of one number by itself and its derivative.
template <int n, class Function, class Derivative>
Dual<n> applied(const Dual<n>& x, Function function, Derivative derivative) {
  const Lanes value = eachLane(x.value, function);
  return n == 0 ? Dual<n>(value) : along(value, x, eachLane(x.value, derivative));
}

}  // namespace mortier
