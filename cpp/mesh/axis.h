// Bodies of revolution: a mesh in the half plane x >= 0 turns about the axis x = 0. Then x is the radius r
// and y the coordinate z along the axis; what is integrated over the mesh or its sides is of the whole ring,
//   int f dV = int f 2 pi r dA,   int f dS = int f 2 pi r ds.
#pragma once

#include <numbers>

#include "base/types.h"
#include "mesh/triangle_mesh.h"

namespace mortier {

/// 2 pi r [m].
inline double circumference(const Point& place) {
  return 2 * std::numbers::pi * place.x();
}

/// Vertices that only rounding keeps from the axis are put on it.
/// \throws InputError with the first vertex on the other side of it. \param beside  the key that asks for it
TriangleMesh meshAboutAxis(TriangleMesh mesh, const char* beside = "plane = \"axisymmetric\"");

}  // namespace mortier
