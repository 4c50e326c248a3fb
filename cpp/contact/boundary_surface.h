// The curved surface behind the boundary of a mesh of tetrahedra.
//
// Its normals at vertices are those of the geometry where the mesh has them (boundaryNormals). Elsewhere
// they are those of quadrics
//
//   z = a x + b y + c (x^2 + z^2/2) + d x y + e (y^2 + z^2/2) + z (f x + g y + h z)
//
// through the vertex, with z along its normal, fitted to the neighbours of two rings by least squares: exact
// on all surfaces of second degree where the neighbours tell them from others; what these cannot tell of f, g
// and h is 0, as on a sphere. A vertex where no such surface passes, as the apex of a cone, has no normal.
//
// Labels and supports do not matter. Surfaces end at corners, as the lines of a plane mesh (smooth_part.h):
// at edges that turn by more than 40 degrees, or by more than one degree and more than four times as much,
// over the length, as the surface on both sides of them.
#pragma once

#include <array>
#include <optional>
#include <vector>

#include "base/types.h"
#include "mesh/tetrahedron_mesh.h"

namespace mortier {

struct SurfaceNormal {
  SpacePoint n{0, 0, 0};  ///< outward, of length one; that of the triangle where there is none
  bool known = false;     ///< whether there is one
  double error = 0;       ///< expected, an angle [rad]
};

struct BoundarySurface {
  std::vector<std::array<int, 3>>
      triangles;                   ///< those with a label in the order of the mesh, then the others
  std::vector<SpacePoint> facets;  ///< normals of the triangles
  std::vector<int> parts;          ///< by triangles: which turn smoothly into each other
  std::vector<std::array<SurfaceNormal, 3>> normals;  ///< by triangles and vertices
};

/// \param label  on which normals are asked for, elsewhere none is known; none: everywhere
BoundarySurface boundarySurface(const TetrahedronMesh& mesh, std::optional<int> label = {});

}  // namespace mortier
