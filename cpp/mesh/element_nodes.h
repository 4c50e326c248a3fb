// The nodes of a mesh whose displacements are polynomials of a degree: the vertices, and for degree 2 the
// middles of all edges beside them.
#pragma once

#include <array>
#include <vector>

#include "base/types.h"
#include "mesh/triangle_mesh.h"

namespace mortier {

/// An edge of the boundary, or half of one where it has a node in its middle.
struct BoundaryStretch {
  std::array<int, 2> nodes{};  ///< the body to the left
  int edge = 0;                ///< of TriangleMesh::boundaryEdges
};

struct ElementNodes {
  int degree = 1;
  std::vector<Point> places;  ///< [m]; vertices first, numbered as in the mesh
  std::vector<int> elements;  ///< 3 or 6 per triangle: vertices, then the middles of the sides 0-1, 1-2, 2-0
  std::vector<int> middles;   ///< of each labelled boundary edge; empty for degree 1
  std::vector<BoundaryStretch> boundary;  ///< of the labelled boundary, edge by edge

  [[nodiscard]] int perElement() const { return degree == 1 ? 3 : 6; }
  /// Of a triangle.
  [[nodiscard]] const int* of(size_t triangle) const {
    return &elements[triangle * static_cast<size_t>(perElement())];
  }
  [[nodiscard]] int count() const { return static_cast<int>(places.size()); }
};

/// \param degree  1 or 2. A middle on the boundary lies where TriangleMesh::edgeMiddles says, others halfway.
ElementNodes elementNodes(const TriangleMesh& mesh, int degree);

// Shape functions on an edge of an element, and numbers of its nodes: the two ends, then the middle.

struct LinearEdge {
  static constexpr std::array<double, 2> shapes(double xi) { return {1 - xi, xi}; }
};

struct QuadraticEdge {
  static constexpr std::array<double, 3> shapes(double xi) {
    return {(1 - xi) * (1 - 2 * xi), xi * (2 * xi - 1), 4 * xi * (1 - xi)};
  }
};

/// One value a node of an edge: two or three.
using EdgeValues = Eigen::Matrix<double, Eigen::Dynamic, 1, 0, 3, 1>;
using EdgeNodes = Eigen::Matrix<int, Eigen::Dynamic, 1, 0, 3, 1>;

/// \param xi  part of the edge from its first end
inline EdgeValues edgeShapes(int degree, double xi) {
  if (degree == 1) return EdgeValues{{1 - xi, xi}};
  const auto [a, b, middle] = QuadraticEdge::shapes(xi);
  return EdgeValues{{a, b, middle}};
}

}  // namespace mortier
