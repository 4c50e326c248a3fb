// Numbers with their derivatives (forward mode of automatic differentiation) for laws of one's own: a value
// and its slopes along n directions, as Ceres' Jet and Eigen's AutoDiffScalar have them; Dual<0> is a value
// alone. Where a slope is 0 a product with it is 0 whatever the other factor, so that sqrt(s11^2) has the
// slope 0 at 0, not NaN as with those.
#pragma once

#include <array>
#include <cmath>
#include <limits>

namespace mortier {

template <int n>
struct Dual {
  double value = 0;
  std::array<double, n> slope{};

  Dual() = default;
  Dual(double x) : value(x) {}
};

/// dx * slope, 0 where the slope is.
template <int n>
void addAlong(Dual<n>& result, const Dual<n>& x, double dx) {
  if constexpr (n > 0) {
    if (std::abs(dx) <= std::numeric_limits<double>::max())
      for (int k = 0; k < n; ++k) result.slope[k] += dx * x.slope[k];
    else
      for (int k = 0; k < n; ++k) result.slope[k] += x.slope[k] == 0 ? 0 : dx * x.slope[k];
  }
}
template <int n>
Dual<n> along(double value, const Dual<n>& x, double dx) {
  Dual<n> result(value);
  addAlong(result, x, dx);
  return result;
}
template <int n>
Dual<n> along(double value, const Dual<n>& x, double dx, const Dual<n>& y, double dy) {
  Dual<n> result = along(value, x, dx);
  addAlong(result, y, dy);
  return result;
}

template <int n>
Dual<n> operator-(const Dual<n>& x) {
  return along(-x.value, x, -1.0);
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
  const double quotient = x.value / y.value;
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
  return along(x.value * y, x, y);
}
template <int n>
Dual<n> operator*(double x, const Dual<n>& y) {
  return y * x;
}
template <int n>
Dual<n> operator/(const Dual<n>& x, double y) {
  return along(x.value / y, x, 1 / y);
}
template <int n>
Dual<n> operator/(double x, const Dual<n>& y) {
  return Dual<n>(x) / y;
}

template <int n>
bool operator<(const Dual<n>& x, const Dual<n>& y) {
  return x.value < y.value;
}
template <int n>
bool operator>(const Dual<n>& x, const Dual<n>& y) {
  return y < x;
}
template <int n>
bool operator<(const Dual<n>& x, double y) {
  return x.value < y;
}
template <int n>
bool operator>(const Dual<n>& x, double y) {
  return x.value > y;
}

template <int n>
Dual<n> max(const Dual<n>& x, const Dual<n>& y) {
  return y < x ? x : y;
}
template <int n>
Dual<n> min(const Dual<n>& x, const Dual<n>& y) {
  return x < y ? x : y;
}
template <int n>
Dual<n> max(double x, const Dual<n>& y) {
  return max(Dual<n>(x), y);
}
template <int n>
Dual<n> min(double x, const Dual<n>& y) {
  return min(Dual<n>(x), y);
}

template <int n>
Dual<n> abs(const Dual<n>& x) {
  return along(std::abs(x.value), x, x.value < 0 ? -1 : x.value > 0 ? 1 : 0);
}
template <int n>
Dual<n> sqrt(const Dual<n>& x) {
  const double root = std::sqrt(x.value);
  return along(root, x, 0.5 / root);
}
template <int n>
Dual<n> exp(const Dual<n>& x) {
  const double power = std::exp(x.value);
  return along(power, x, power);
}
template <int n>
Dual<n> log(const Dual<n>& x) {
  return along(std::log(x.value), x, 1 / x.value);
}

/// x^y; small whole powers without logarithms.
inline double power(double x, double y) {
  constexpr int most = 16;
  if (y != std::rint(y) || std::abs(y) > most) return std::pow(x, y);
  double result = 1;
  double square = x;
  for (int left = std::abs(static_cast<int>(y)); left > 0; left /= 2, square *= square)
    if (left % 2 == 1) result *= square;
  return y < 0 ? 1 / result : result;
}
template <int n>
Dual<n> pow(const Dual<n>& x, double y) {
  const double value = power(x.value, y);
  if constexpr (n == 0) return value;
  return along(value, x, y * (x.value == 0 ? power(x.value, y - 1) : value / x.value));
}
template <int n>
Dual<n> pow(const Dual<n>& x, const Dual<n>& y) {
  const double value = std::pow(x.value, y.value);
  if constexpr (n == 0) return value;
  return along(value, x, y.value * std::pow(x.value, y.value - 1), y, std::log(x.value) * value);
}

}  // namespace mortier
