// The sides of all elements of a mesh, sorted by their vertices: those in one place are next to each other.
#pragma once

#include <span>
#include <vector>

#include "mesh/simplices.h"

namespace mortier {

/// Of a triangle from vertex k to the next; of a tetrahedron opposite to vertex k, counterclockwise from
/// outside where its volume is positive.
inline std::array<int, 2> sideOf(const std::array<int, 3>& triangle, int k) {
  return {triangle[k], triangle[(k + 1) % 3]};
}
inline std::array<int, 3> sideOf(const std::array<int, 4>& tetrahedron, int k) {
  constexpr std::array<std::array<int, 3>, 4> opposite{{{1, 2, 3}, {0, 3, 2}, {0, 1, 3}, {0, 2, 1}}};
  const auto& [a, b, c] = opposite[k];
  return {tetrahedron[a], tetrahedron[b], tetrahedron[c]};
}

template <size_t n>
struct ElementSide {
  std::array<int, n> vertices;  ///< ascending
  int place = 0;                ///< (n + 1) element + k

  [[nodiscard]] int element() const { return place / static_cast<int>(n + 1); }
  [[nodiscard]] int corner() const { return place % static_cast<int>(n + 1); }
};

template <size_t n>
using ElementSides = std::vector<ElementSide<n>>;

/// Those in one place by their elements. In linear time, but for the sides at a vertex. \pre all vertices
/// exist
template <size_t n>
ElementSides<n - 1> sortedSides(const std::vector<std::array<int, n>>& elements, size_t vertices);
template <class Mesh>
auto sortedSides(const Mesh& mesh) {
  return sortedSides(elementsOf(mesh), mesh.vertices.size());
}

/// The sides with these vertices, which may come in any order; none where there is no such side.
template <size_t n>
std::span<const ElementSide<n>> sidesOn(const ElementSides<n>& sides, std::array<int, n> vertices) {
  std::sort(vertices.begin(), vertices.end());
  const auto first = std::ranges::lower_bound(sides, vertices, {}, &ElementSide<n>::vertices);
  auto last = first;
  while (last != sides.end() && last->vertices == vertices) ++last;
  return {first, last};
}

/// Calls visit with the sides in each place.
template <size_t n, class Visit>
void forEachPlace(const ElementSides<n>& sides, Visit visit) {
  for (size_t begin = 0, end = 0; begin < sides.size(); begin = end) {
    while (end < sides.size() && sides[end].vertices == sides[begin].vertices) ++end;
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
