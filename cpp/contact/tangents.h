// Directions of slip on a surface.
#pragma once

#include <Eigen/Geometry>
#include <array>

#include "base/types.h"

namespace mortier {

/// Two directions normal to n and to each other; t1 is nearest to the axis that is most nearly normal to n,
/// so that on a plane of symmetry along axes one lies in the plane and the other is normal to it.
inline std::array<SpacePoint, 2> tangentsTo(const SpacePoint& n) {
  Eigen::Index axis = 0;
  n.cwiseAbs().minCoeff(&axis);
  const SpacePoint t1 = (SpacePoint::Unit(axis) - n[axis] * n).normalized();
  return {t1, n.cross(t1)};
}

/// A direction t normal to n0 where the normal is n: turned by the least rotation from n0 to n, which are not
/// opposite.
inline SpacePoint turnedWith(const SpacePoint& t, const SpacePoint& n0, const SpacePoint& n) {
  return t - n.dot(t) / (1 + n.dot(n0)) * (n0 + n);
}

}  // namespace mortier
