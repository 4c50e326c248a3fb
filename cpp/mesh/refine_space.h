// Tetrahedra cut in two, and their neighbours with them until no vertex lies inside an edge: longest-edge
// bisection (Rivara 1991). An edge is cut when it is the longest one of all tetrahedra around it; where it is
// not, the longest edges of those tetrahedra are cut first. So every tetrahedron is halved through its
// longest edge, in whatever order they are marked.
#pragma once

#include "mesh/refine.h"
#include "mesh/tetrahedron_mesh.h"

namespace mortier {

/// The curved surface for which the boundary of a mesh stands: normals at its vertices. Empty where all sides
/// are plane.
struct CurvedFaces {
  std::vector<std::array<int, 3>> triangles;         ///< of the whole boundary, labelled or not
  std::vector<int> parts;                            ///< of each: which turn smoothly into each other
  std::map<std::array<int, 2>, SpacePoint> normals;  ///< by vertices and parts, of length one
};

using RefinedTetrahedra = BisectedMesh<TetrahedronMesh, CurvedFaces>;

/// Cuts the tetrahedra that are marked, and as many more as it takes. A new vertex of the boundary is put
/// onto the arc over its edge that is perpendicular to the normals at both ends, or, where two parts meet in
/// an edge, to those of both; back towards the chord where a half would have less than a quarter of its
/// volume. Regions, labels and names go on.
/// \param marked  by tetrahedron
RefinedTetrahedra bisect(const TetrahedronMesh& mesh, const CurvedFaces& curves,
                         const std::vector<char>& marked);

/// From the middle of an edge d to that of the arc over it, by its tangents of length one at both ends: exact
/// on circles. 0 where it is straight or turns too far.
SpacePoint sagittaOf(const SpacePoint& d, const SpacePoint& from, const SpacePoint& to);

}  // namespace mortier
