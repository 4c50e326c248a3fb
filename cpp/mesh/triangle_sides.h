// The sides of all triangles of a mesh, sorted by their vertices: those on one edge are next to each other.
#pragma once

#include <span>
#include <vector>

#include "mesh/triangle_mesh.h"

namespace mortier {

struct TriangleSide {
  std::array<int, 2> edge;  ///< its vertices, the lower one first
  int place = 0;            ///< 3 triangle + k, of the side from vertex k of the triangle to the next

  [[nodiscard]] int triangle() const { return place / 3; }
  [[nodiscard]] int corner() const { return place % 3; }
};

using TriangleSides = std::vector<TriangleSide>;

/// Those on one edge by their places. In linear time, but for the sides at a vertex. \pre all vertices exist
TriangleSides sortedSides(const TriangleMesh& mesh);

/// The sides on an edge, whose vertices may come in either order; none where there is no such edge.
std::span<const TriangleSide> sidesOn(const TriangleSides& sides, int a, int b);

/// Calls visit with the sides of each edge.
template <class Visit>
void forEachEdge(const TriangleSides& sides, Visit visit) {
  for (size_t begin = 0, end = 0; begin < sides.size(); begin = end) {
    while (end < sides.size() && sides[end].edge == sides[begin].edge) ++end;
    visit(std::span(sides).subspan(begin, end - begin));
  }
}

// What of a mesh hangs together: components of triangles that share edges are rigid in themselves; where two
// of them share a single vertex they can turn about it, as about a hinge.

struct EdgeComponents {
  int count = 0;
  std::vector<int> of;  ///< component of each triangle, numbered in the order of their first triangles
};

/// Triangles that share edges, directly or through others. In linear time.
EdgeComponents edgeComponents(const TriangleMesh& mesh);

}  // namespace mortier
