// Generated meshes of tetrahedra.
#pragma once

#include <variant>

#include "mesh/tetrahedron_mesh.h"

namespace mortier {

struct Cuboid {
  SpacePoint lower{0, 0, 0};  ///< [m]
  SpacePoint upper{1, 1, 1};  ///< [m]
  std::array<int, 3> cells{1, 1, 1};
};

/// Every cell cut into six tetrahedra about a diagonal (Kuhn). Labels: 1 bottom, 2 right, 3 top, 4 left, as
/// of a rectangle in x and z, 5 front, 6 back (the least and the largest y). \throws InputError on empty
/// boxes and cell counts below 1.
TetrahedronMesh cuboidMesh(const Cuboid& cuboid);

/// A ball, or a cylinder along z, or a part of it.
struct RoundBody {
  bool ball = false;
  SpacePoint centre{0, 0, 0};      ///< of the ball, or of the bottom of the cylinder [m]
  double radius = 1;               ///< [m]
  double height = 1;               ///< of a cylinder [m]
  std::array<int, 3> keep{};       ///< by axes: 1 beyond the centre only, -1 before it only, 0 both
  std::array<int, 2> cells{1, 1};  ///< along a radius, and along the height
};

/// A box of cells whose squares or cubes about the centre become circles or spheres. Labels: those of a
/// cuboid for plane sides, 7 "round" for the round one. \throws InputError unless sizes are positive.
TetrahedronMesh roundMesh(const RoundBody& body);

using SpaceShape = std::variant<Cuboid, RoundBody>;
inline TetrahedronMesh shapeMesh(const SpaceShape& shape) {
  if (const auto* round = std::get_if<RoundBody>(&shape)) return roundMesh(*round);
  return cuboidMesh(std::get<Cuboid>(shape));
}

}  // namespace mortier
