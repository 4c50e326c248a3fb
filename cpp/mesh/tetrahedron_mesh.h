// Meshes of tetrahedra with labels, and the nodes of displacements on them.
#pragma once

#include <array>
#include <map>
#include <string>
#include <vector>

#include "base/types.h"
#include "mesh/geometry_surfaces.h"

namespace mortier {

/// A conforming mesh of tetrahedra of one body.
struct TetrahedronMesh {
  std::string name;                                   ///< where it came from, for messages
  std::vector<SpacePoint> vertices;                   ///< [m]
  std::vector<std::array<int, 4>> tetrahedra;         ///< vertex numbers, of positive volume
  std::vector<int> regions;                           ///< label of each tetrahedron
  std::vector<std::array<int, 3>> boundaryTriangles;  ///< counterclockwise seen from outside
  std::vector<int> boundaryLabels;                    ///< label of each boundary triangle
  std::map<std::string, int> labelNames = {};         ///< boundary labels that have a name
  std::map<std::string, int> regionNames = {};
  // Where groups of a file share sides or elements, until the scene chooses (mesh/regions.h): the groups of
  // each label, and of each region, that stands for several.
  std::map<int, std::vector<int>> sharedLabels = {};
  std::map<int, std::vector<int>> sharedRegions = {};
  std::string changed = {};  ///< what the reader made of other cells; empty: none were there
  /// By boundary triangles and their vertices: outward normals of the geometry behind them, of length one;
  /// not finite where that is not known. Empty: nowhere.
  std::vector<std::array<SpacePoint, 3>> boundaryNormals = {};
  BoundaryGeometry geometry = {};
};

/// Checks what the solver relies on, and orients tetrahedra and boundary triangles: finite coordinates, no
/// vertex out of range or unused, no tetrahedron flat or repeated, every triangle shared by two tetrahedra at
/// most, one on each side, labelled triangles on the boundary, each labelled once. A tetrahedron is flat when
/// its volume is 1e-12 of the cube of its longest edge or less. \throws InputError with the first fault.
void validate(TetrahedronMesh& mesh);
/// The first of these checks: that there is every vertex that tetrahedra and triangles name. \throws
/// InputError
void requireVertices(const TetrahedronMesh& mesh);

/// The triangles that belong to one tetrahedron, labelled or not, counterclockwise seen from outside.
std::vector<std::array<int, 3>> outerTriangles(const TetrahedronMesh& mesh);
/// Their labels, -1 where they have none.
std::vector<int> labelsOf(const TetrahedronMesh& mesh, const std::vector<std::array<int, 3>>& outer);
/// Of a tetrahedron, negative where it is turned over [m^3].
double volume(const TetrahedronMesh& mesh, const std::array<int, 4>& tetrahedron);

/// Largest extent of the bounding box [m].
double extent(const TetrahedronMesh& mesh);

/// Ratio of the longest edge to the smallest height, over that of the regular tetrahedron: 1 is best.
double aspectRatio(const TetrahedronMesh& mesh, int t);

/// Sides of a tetrahedron, in the order of their middles among its nodes.
inline constexpr std::array<std::array<int, 2>, 6> sidesOfTetrahedron{
    {{0, 1}, {1, 2}, {2, 0}, {0, 3}, {1, 3}, {2, 3}}};

/// Nodes of displacements of a degree: the vertices, and for degree 2 the middles of all edges after them.
struct SpaceNodes {
  int degree = 1;
  std::vector<SpacePoint> places;  ///< [m]; vertices first, numbered as in the mesh
  std::vector<int> elements;       ///< 4 or 10 per tetrahedron: vertices, then middles (sidesOfTetrahedron)
  /// Of each boundary triangle: its vertices, then the middles of its sides 0-1, 1-2, 2-0 (-1 for degree 1).
  std::vector<std::array<int, 6>> faces;

  [[nodiscard]] int perElement() const { return degree == 1 ? 4 : 10; }
  [[nodiscard]] int perFace() const { return degree == 1 ? 3 : 6; }
  /// Of a tetrahedron.
  [[nodiscard]] const int* of(size_t element) const {
    return &elements[element * static_cast<size_t>(perElement())];
  }
  [[nodiscard]] int count() const { return static_cast<int>(places.size()); }
};

/// Values of the shape functions of a boundary triangle, in the order of its nodes. \param b  barycentric
inline std::array<double, 6> traceShapes(int degree, const Eigen::Vector3d& b) {
  if (degree == 1) return {b[0], b[1], b[2], 0, 0, 0};
  return {b[0] * (2 * b[0] - 1), b[1] * (2 * b[1] - 1), b[2] * (2 * b[2] - 1),
          4 * b[0] * b[1],       4 * b[1] * b[2],       4 * b[2] * b[0]};
}

/// \param degree  1 or 2; sides are straight.
SpaceNodes spaceNodes(const TetrahedronMesh& mesh, int degree);

}  // namespace mortier
