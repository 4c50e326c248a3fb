#pragma once

#include <cmath>

namespace mortier {

/// The root of f in [0, 1], with values f0, f1 of opposite signs at both ends, by false position (Illinois).
template <class F>
double rootOf(const F& f, double f0, double f1) {
  constexpr double rounding = 4e-16;
  const double scale = rounding * (std::abs(f0) + std::abs(f1));
  double low = 0;
  double high = 1;
  int side = 0;
  for (int k = 0; k < 100; ++k) {
    const double xi = low + (high - low) * (f0 / (f0 - f1));
    if (!(xi > low && xi < high)) break;
    const double here = f(xi);
    if (std::abs(here) <= scale) return xi;
    const bool isLow = (here >= 0) == (f0 >= 0);
    (isLow ? low : high) = xi;
    (isLow ? f0 : f1) = here;
    if (isLow && side == 1) f1 /= 2;
    if (!isLow && side == -1) f0 /= 2;
    side = isLow ? 1 : -1;
  }
  return std::abs(f0) <= std::abs(f1) ? low : high;
}

}  // namespace mortier
