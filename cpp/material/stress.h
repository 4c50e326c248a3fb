// Stress and strain as vectors in the basis in which plane isotropic elasticity is diagonal:
//   p = (s11 + s22)/sqrt2,  q = (s11 - s22)/sqrt2,  r = sqrt2 s12,
// and the same for strains, so that the scalar product of two vectors is sigma : eps.
// Further components (s33 in plane strain) follow; strains of the plane act on the first three.
#pragma once

#include <cmath>
#include <numbers>

#include "base/types.h"

namespace mortier {

/// (p, q, r) to (s11, s22, s12).
inline Eigen::Vector3d toCartesian(const Eigen::Vector3d& pqr) {
  constexpr double h = std::numbers::sqrt2 / 2;
  return {h * (pqr[0] + pqr[1]), h * (pqr[0] - pqr[1]), h * pqr[2]};
}

/// (s11, s22, s12) to (p, q, r).
inline Eigen::Vector3d fromCartesian(const Eigen::Vector3d& s) {
  constexpr double h = std::numbers::sqrt2 / 2;
  return {h * (s[0] + s[1]), h * (s[0] - s[1]), std::numbers::sqrt2 * s[2]};
}

/// sqrt(s11^2 + s22^2 - s11 s22 + 3 s12^2) [Pa], plane stress.
inline double vonMises(const Eigen::Vector3d& pqr) {
  return std::sqrt(0.5 * pqr[0] * pqr[0] + 1.5 * (pqr[1] * pqr[1] + pqr[2] * pqr[2]));
}

}  // namespace mortier
