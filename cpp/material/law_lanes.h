// Vectors and matrices for laws that are evaluated at eight points at once.
#pragma once

#include "base/lanes.h"
#include "base/types.h"

namespace mortier {

using LaneVector = std::array<Lanes, 3>;  ///< on p, q, r, or on three deviatoric directions

inline Lanes dot(const LaneVector& x, const LaneVector& y) {
  return x[0] * y[0] + x[1] * y[1] + x[2] * y[2];
}

/// diag(d) - c x y' as a 3 x 3 matrix, column major.
inline std::array<Lanes, 9> diagonalMinusRankOne(const LaneVector& d, const Lanes& c, const LaneVector& x,
                                                 const LaneVector& y) {
  std::array<Lanes, 9> result;
  for (int j = 0; j < 3; ++j) {
    for (int i = 0; i < 3; ++i) result[3 * j + i] = -(c * x[i]) * y[j];
    result[3 * j + j] += d[j];
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
