#include "base/taylor.h"

#include <algorithm>
#include <numbers>

namespace mortier {
namespace {

constexpr int order = Taylor::order;

/// Outwards by what a few roundings are.
Interval wide(double least, double largest) {
  if (std::isnan(least) || std::isnan(largest)) return Interval::anything();
  const auto out = [](double x, double to) { return std::nextafter(std::nextafter(x, to), to); };
  return {out(least, -infinity), out(largest, infinity)};
}

template <class Function>
Interval ascending(const Interval& a, Function function) {
  return wide(function(a.least), function(a.largest));
}

/// sin(x + shift)
Interval sine(const Interval& a, double shift) {
  constexpr double pi = std::numbers::pi;
  if (!(a.largest - a.least < 2 * pi)) return {-1, 1};
  const double left = std::sin(a.least + shift);
  const double right = std::sin(a.largest + shift);
  Interval range = wide(std::min(left, right), std::max(left, right));
  const double margin = 1e-15 * (1 + a.magnitude());  // of x + shift
  const auto passes = [&](double angle) {
    return std::floor((a.largest + shift + margin - angle) / (2 * pi)) >
           std::floor((a.least + shift - margin - angle) / (2 * pi));
  };
  range = {range.least - margin, range.largest + margin};
  if (passes(pi / 2)) range.largest = 1;
  if (passes(-pi / 2)) range.least = -1;
  return range;
}

/// The last coefficient that is not 0.
int last(const Taylor& u) {
  int k = order;
  while (k > 0 && u.c[k].isZero()) --k;
  return k;
}

/// (1/k) times the sum of i u_i w_{k-i} for i = 1 ... last.
Interval weighted(const Taylor& u, const Taylor& w, int k, int last) {
  Interval sum;
  for (int i = 1; i <= last; ++i) {
    const double part = static_cast<double>(i) / k;
    if (u.c[i].isZero() || w.c[k - i].isZero()) continue;
    sum = sum + wide(part, part) * u.c[i] * w.c[k - i];
  }
  return sum;
}

}  // namespace

Interval operator-(const Interval& a) {
  return {-a.largest, -a.least};
}
Interval operator+(const Interval& a, const Interval& b) {
  if (a.isZero()) return b;
  if (b.isZero()) return a;
  return wide(a.least + b.least, a.largest + b.largest);
}
Interval operator-(const Interval& a, const Interval& b) {
  return a + -b;
}
Interval operator*(const Interval& a, const Interval& b) {
  if (a.isZero() || b.isZero()) return {};
  const auto times = [](double x, double y) { return x == 0 || y == 0 ? 0 : x * y; };
  const auto [least, largest] = std::minmax({times(a.least, b.least), times(a.least, b.largest),
                                             times(a.largest, b.least), times(a.largest, b.largest)});
  return wide(least, largest);
}
Interval operator/(const Interval& a, const Interval& b) {
  if (b.holds(0)) return Interval::anything();
  if (a.isZero()) return {};
  return a * wide(1 / b.largest, 1 / b.least);
}
Interval hull(const Interval& a, const Interval& b) {
  return {std::min(a.least, b.least), std::max(a.largest, b.largest)};
}

Taylor operator-(const Taylor& u) {
  Taylor result;
  for (int k = 0; k <= order; ++k) result.c[k] = -u.c[k];
  return result;
}
Taylor operator+(const Taylor& u, const Taylor& v) {
  Taylor result;
  for (int k = 0; k <= order; ++k) result.c[k] = u.c[k] + v.c[k];
  return result;
}
Taylor operator-(const Taylor& u, const Taylor& v) {
  return u + -v;
}
Taylor operator*(const Taylor& u, const Taylor& v) {
  Taylor result;
  const int most = last(u);
  const int other = last(v);
  for (int k = 0; k <= std::min(order, most + other); ++k)
    for (int i = std::max(0, k - other); i <= std::min(k, most); ++i)
      result.c[k] = result.c[k] + u.c[i] * v.c[k - i];
  return result;
}
Taylor operator/(const Taylor& u, const Taylor& v) {
  Taylor result;
  const int most = last(v) > 0 ? order : last(u);
  for (int k = 0; k <= most; ++k) {
    Interval left = u.c[k];
    for (int i = 1; i <= k; ++i) left = left - v.c[i] * result.c[k - i];
    result.c[k] = left / v.c[0];
  }
  return result;
}

Taylor exp(const Taylor& u) {
  Taylor w;
  w.c[0] = ascending(u.c[0], [](double x) { return std::exp(x); });
  for (int k = 1; k <= order && last(u) > 0; ++k) w.c[k] = weighted(u, w, k, k);
  return w;
}

Taylor log(const Taylor& u) {
  const double tiny = std::max(u.c[0].least, 0.0);
  Taylor w = Taylor::within(
      wide(tiny > 0 ? std::log(tiny) : -infinity, u.c[0].largest > 0 ? std::log(u.c[0].largest) : infinity));
  if (last(u) == 0) return Taylor::constant(w.c[0]);
  if (!(u.c[0].least > 0)) return w;
  for (int k = 1; k <= order; ++k) w.c[k] = (u.c[k] - weighted(w, u, k, k - 1)) / u.c[0];
  return w;
}

Taylor pow(const Taylor& u, double a) {
  constexpr double largestProduct = 64;
  if (!(u.c[0].least > 0)) {
    if (a == std::floor(a) && std::abs(a) <= largestProduct) {
      const Taylor one = Taylor::constant({1, 1});
      Taylor product = one;
      for (int i = 0; i < std::abs(a); ++i) product = product * u;
      const double ends[] = {std::pow(u.c[0].least, std::abs(a)), std::pow(u.c[0].largest, std::abs(a))};
      product.c[0] = wide(std::fmod(a, 2) != 0 || u.c[0].largest < 0 ? std::min(ends[0], ends[1]) : 0,
                          std::max(ends[0], ends[1]));
      return a < 0 ? one / product : product;
    }
    // What is below 0 is rounding of the enclosure: the power has no values there.
    if (!(a > 0 && u.c[0].largest >= 0)) return Taylor::within(Interval::anything());
    const Interval values =
        ascending({std::max(u.c[0].least, 0.0), u.c[0].largest}, [&](double x) { return std::pow(x, a); });
    return last(u) == 0 ? Taylor::constant(values) : Taylor::within(values);
  }
  Taylor w;
  const double ends[] = {std::pow(u.c[0].least, a), std::pow(u.c[0].largest, a)};
  w.c[0] = wide(std::min(ends[0], ends[1]), std::max(ends[0], ends[1]));
  for (int k = 1; k <= order && last(u) > 0; ++k) {
    Interval sum;
    for (int i = 1; i <= k; ++i) {
      const double factor = (a * i - (k - i)) / k;
      sum = sum + wide(factor, factor) * u.c[i] * w.c[k - i];
    }
    w.c[k] = sum / u.c[0];
  }
  return w;
}

std::array<Taylor, 2> sinAndCos(const Taylor& u) {
  Taylor s;
  Taylor c;
  s.c[0] = sine(u.c[0], 0);
  c.c[0] = sine(u.c[0], std::numbers::pi / 2);
  for (int k = 1; k <= order && last(u) > 0; ++k) {
    s.c[k] = weighted(u, c, k, k);
    c.c[k] = -weighted(u, s, k, k);
  }
  return {s, c};
}

Taylor integrated(const Taylor& u, const Taylor& q, const Interval& values) {
  Taylor w;
  w.c[0] = values;
  for (int k = 1; k <= order && last(u) > 0; ++k) w.c[k] = (u.c[k] - weighted(w, q, k, k - 1)) / q.c[0];
  return w;
}

}  // namespace mortier
