// Triangles cut in two, and their neighbours with them until no vertex lies inside an edge: longest-edge
// bisection (Rivara 1984). A triangle a, b, c is cut from c to the middle m of its longest side a-b, which
// makes c, a, m and b, c, m; these are cut once more where c-a or b-c is cut. However often that is done, no
// angle is smaller than half of the smallest one of the first mesh (Rosenberg and Stenger 1975), and long
// triangles become rounder.
#pragma once

#include <algorithm>
#include <array>
#include <cmath>
#include <map>
#include <memory>
#include <tuple>
#include <vector>

#include "mesh/tetrahedron_mesh.h"
#include "mesh/triangle_mesh.h"

namespace mortier {

/// The curvature of the arc behind an edge, by its vertices in their order [1/m]: positive where the arc is
/// to the right of the edge. Edges that are not listed are straight, or on a curve of the mesh's own
/// (TriangleMesh::edgeCurves).
using CurvedEdges = std::map<std::array<int, 2>, double>;

/// Of triangles or tetrahedra.
template <class Mesh, class Curves>
struct BisectedMesh {
  Mesh mesh;                  ///< the vertices of the mesh before, and new ones behind them
  Curves curves;              ///< of its edges
  std::vector<int> parents;   ///< of each element, that of the mesh before of which it is a part
  std::vector<int> offCurve;  ///< new vertices that are off their curve: on it, an element would turn over
};
using RefinedMesh = BisectedMesh<TriangleMesh, CurvedEdges>;

/// What orders the sides of elements by their lengths, from the same end, so that all elements of a side get
/// the same bits; lengths that differ by rounding are equal, so that units and rotations change nothing.
template <class Place>
std::tuple<double, int, int> rankOfSide(const std::vector<Place>& vertices, int a, int b) {
  constexpr double digits = 0x1p30;
  const auto [low, high] = std::minmax(a, b);
  const double length = std::log2((vertices[high] - vertices[low]).squaredNorm());
  return {std::round(digits * length), high, low};
}

/// Whether a boundary edge is known to be straight (TriangleMesh::edgeMiddles).
bool isStraight(const TriangleMesh& mesh, size_t edge);

/// Cuts the triangles that are marked, and as many more as it takes. New vertices of curved edges are put
/// onto their arcs or curves, as far from one end as from the other. Regions, labels, names, the middles and
/// the curves of edges go on.
/// \param marked  by triangle
RefinedMesh bisect(const TriangleMesh& mesh, const CurvedEdges& curves, const std::vector<char>& marked);

/// The middle of the arc over an edge from `a` to `b`.
Point middleOfArc(const Point& a, const Point& b, double curvature);

// Tetrahedra cut in two, and their neighbours with them until no vertex lies inside an edge: longest-edge
// bisection (Rivara 1991). An edge is cut when it is the longest one of all tetrahedra around it; where it is
// not, the longest edges of those tetrahedra are cut first. So every tetrahedron is halved through its
// longest edge, in whatever order they are marked.

/// The curved surface for which the boundary of a mesh stands: normals at its vertices. Empty where all sides
/// are plane.
struct CurvedFaces {
  std::vector<std::array<int, 3>> triangles;  ///< of the whole boundary, labelled or not
  /// Of each: which turn smoothly into each other, or partOfSurface() where the geometry knows the surface.
  std::vector<int> parts;
  /// By vertices and parts, of length one; not finite where there is none.
  std::map<std::array<int, 2>, SpacePoint> normals;
  std::shared_ptr<const GeometrySurfaces> geometry = nullptr;
};

inline int partOfSurface(int surface) {
  return -1 - surface;
}
/// \pre part < 0
inline int surfaceOfPart(int part) {
  return -1 - part;
}

using RefinedTetrahedra = BisectedMesh<TetrahedronMesh, CurvedFaces>;

/// Cuts the tetrahedra that are marked, and as many more as it takes. A new vertex of the boundary is put
/// onto the arc over its edge that is perpendicular to the normals at both ends, or, where two parts meet in
/// an edge, to those of both, and from there onto the surfaces of the geometry where these are known. Where a
/// half of a tetrahedron would have less than a quarter of the volume that it has with the vertex on the
/// chord, vertices inside the body are moved; where that does not suffice the vertex stays on the chord. A
/// vertex on an arc that is not of a geometry is moved back towards the chord until the halves keep that.
/// Where there is no normal at one end the arc is symmetric. Regions, labels, names and what is known of
/// boundaryNormals go on.
/// \param marked  by tetrahedron
RefinedTetrahedra bisect(const TetrahedronMesh& mesh, const CurvedFaces& curves,
                         const std::vector<char>& marked);

/// From the middle of an edge d to that of the arc over it, by its tangents of length one at both ends: exact
/// on circles. 0 where it is straight or turns too far.
SpacePoint sagittaOf(const SpacePoint& d, const SpacePoint& from, const SpacePoint& to);

}  // namespace mortier
