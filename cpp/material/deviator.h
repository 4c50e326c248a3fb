// The coordinates k, q, r (deviator) and h (pressure) of plane strain, and back (plane_strain.h).
#pragma once

#include <numbers>

#include "material/law_lanes.h"

namespace mortier {

/// A stress or a strain; Scalar is a number or a batch of them.
template <class Scalar>
struct Split {
  std::array<Scalar, 3> deviator;  ///< k, q, r
  Scalar pressure;                 ///< h
};

inline constexpr double overRoot3 = std::numbers::inv_sqrt3;
inline constexpr double rootTwoThirds = std::numbers::sqrt2 * std::numbers::inv_sqrt3;

template <class Scalar>
Split<Scalar> split(const std::array<Scalar, 4>& s) {
  return {{overRoot3 * s[0] - rootTwoThirds * s[3], s[1], s[2]}, rootTwoThirds * s[0] + overRoot3 * s[3]};
}

template <class Scalar>
std::array<Scalar, 4> joined(const Split<Scalar>& s) {
  return {overRoot3 * s.deviator[0] + rootTwoThirds * s.pressure, s.deviator[1], s.deviator[2],
          overRoot3 * s.pressure - rootTwoThirds * s.deviator[0]};
}

/// Symmetric moduli D (3 x 3, column major) of the deviator and `bulk` of the pressure as those of the plane, and the row
/// of s33.
template <class Scalar>
struct PlaneModuli {
  std::array<Scalar, 9> plane;
  std::array<Scalar, 4> beyond;
};

template <class Scalar>
PlaneModuli<Scalar> planeModuli(const std::array<Scalar, 9>& D, const Scalar& bulk) {
  PlaneModuli<Scalar> result{D, {}};
  for (const int i : {1, 2, 3, 6}) result.plane[i] *= overRoot3;
  result.plane[0] = D[0] / 3 + 2 * bulk / 3;
  result.beyond = {overRoot3 * rootTwoThirds * (bulk - D[0]), -rootTwoThirds * D[1], -rootTwoThirds * D[2],
                   bulk / 3 + 2 * D[0] / 3};
  return result;
}

}  // namespace mortier
