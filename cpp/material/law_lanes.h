// Vectors and matrices for laws that are evaluated at eight points at once.
#pragma once

#include "base/lanes.h"
#include "base/types.h"

namespace mortier {

using LaneVector = std::array<Lanes, 3>;  ///< on p, q, r, or on three deviatoric directions

template <size_t n>
Lanes dot(const std::array<Lanes, n>& x, const std::array<Lanes, n>& y) {
  Lanes sum = x[0] * y[0];
  for (size_t k = 1; k < n; ++k) sum += x[k] * y[k];
  return sum;
}

/// diag(d) - c x y', column major.
template <size_t n>
std::array<Lanes, n * n> diagonalMinusRankOne(const std::array<Lanes, n>& d, const Lanes& c,
                                              const std::array<Lanes, n>& x, const std::array<Lanes, n>& y) {
  std::array<Lanes, n * n> result;
  for (size_t j = 0; j < n; ++j) {
    for (size_t i = 0; i < n; ++i) result[n * j + i] = -(c * x[i]) * y[j];
    result[n * j + j] += d[j];
  }
  return result;
}

/// The largest |x| so far; NaN and infinity stay, as NaN.
class Largest {
 public:
  template <size_t components>
  void add(const std::array<Lanes, components>& x) {
    for (const Lanes& entry : x) {
      soFar_ = max(soFar_, abs(entry));
      poison_ += entry * 0;
    }
  }
  [[nodiscard]] double value() const {
    double value = 0;
    for (int lane = 0; lane < laneCount; ++lane) value = std::max(value, soFar_[lane]);
    for (int lane = 0; lane < laneCount; ++lane) value += poison_[lane];
    return value;
  }

 private:
  Lanes soFar_ = 0;
  Lanes poison_ = 0;
};

}  // namespace mortier
