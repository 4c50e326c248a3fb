// Stress and strain as vectors in the basis in which plane isotropic elasticity is diagonal:
//   p = (s11 + s22)/sqrt2,  q = (s11 - s22)/sqrt2,  r = sqrt2 s12,
// and the same for strains, so that the scalar product of two vectors is sigma : eps.
// In plane strain s33 follows as a fourth component; strains of the plane act on the first three. In space
// there are six (material/deviatoric.h).
#pragma once

#include <cmath>
#include <numbers>

#include "base/types.h"

namespace mortier {

/// What is zero across the plane; of bodies that turn about the axis x = 0 nothing is: the fourth strain is
/// that of the circumference. None: of bodies in space.
enum class Plane { stress, strain, axisymmetric, none };

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

/// sqrt(3/2 |dev|^2) [Pa] of (p, q, r) in plane stress, of (p, q, r, s33) in plane strain, of six components
/// in space.
inline double vonMises(const Eigen::Ref<const Vector>& stress) {
  if (stress.size() == 6) return std::sqrt(1.5) * stress.head<5>().norm();
  const double p = stress[0];
  const double beyond = stress.size() > 3 ? stress[3] - p * (std::numbers::sqrt2 / 2) : 0;
  const double first = stress.size() > 3 ? beyond * beyond : 0.5 * p * p;
  return std::sqrt(first + 1.5 * (stress[1] * stress[1] + stress[2] * stress[2]));
}

/// (s11, s22, s33, s12, s13, s23) of a stress in space (material/deviatoric.h), and the reverse.
using SpaceStress = Eigen::Matrix<double, 6, 1>;
inline SpaceStress toSpaceCartesian(const SpaceStress& s) {
  constexpr double h = std::numbers::sqrt2 / 2;
  const double mean = s[5] * std::numbers::inv_sqrt3;
  const double k = s[0] * std::numbers::inv_sqrt3 * h;
  SpaceStress all;
  all << mean + k + h * s[1], mean + k - h * s[1], mean - 2 * k, h * s[2], h * s[3], h * s[4];
  return all;
}
inline SpaceStress fromSpaceCartesian(const SpaceStress& s) {
  constexpr double h = std::numbers::sqrt2 / 2;
  constexpr double root2 = std::numbers::sqrt2;
  SpaceStress all;
  all << std::numbers::inv_sqrt3 * h * (s[0] + s[1] - 2 * s[2]), h * (s[0] - s[1]), root2 * s[3],
      root2 * s[4], root2 * s[5], std::numbers::inv_sqrt3 * (s[0] + s[1] + s[2]);
  return all;
}

}  // namespace mortier
