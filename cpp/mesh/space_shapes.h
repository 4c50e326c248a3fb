// Generated meshes of tetrahedra.
#pragma once

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

}  // namespace mortier
