#include "mesh/triangle_sides.h"

#include <algorithm>
#include <numeric>

#include "base/disjoint_sets.h"
#include "base/interrupt.h"

namespace mortier {

TriangleSides sortedSides(const TriangleMesh& mesh) {
  std::vector<size_t> next(mesh.vertices.size() + 1, 0);
  for (const auto& v : mesh.triangles)
    for (int k = 0; k < 3; ++k) ++next[std::min(v[k], v[(k + 1) % 3]) + 1];
  std::partial_sum(next.begin(), next.end(), next.begin());
  TriangleSides sides(3 * mesh.triangles.size());
  for (size_t t = 0; t < mesh.triangles.size(); ++t)
    for (int k = 0; k < 3; ++k) {
      const auto [low, high] = std::minmax(mesh.triangles[t][k], mesh.triangles[t][(k + 1) % 3]);
      sides[next[low]++] = {{low, high}, static_cast<int>(3 * t) + k};
    }
  for (size_t begin = 0, end = 0; begin < sides.size(); begin = end) {
    stopIfInterrupted();
    while (end < sides.size() && sides[end].edge[0] == sides[begin].edge[0]) ++end;
    std::sort(sides.data() + begin, sides.data() + end, [](const TriangleSide& a, const TriangleSide& b) {
      return a.edge[1] != b.edge[1] ? a.edge[1] < b.edge[1] : a.place < b.place;
    });
  }
  return sides;
}

std::span<const TriangleSide> sidesOn(const TriangleSides& sides, int a, int b) {
  const auto [low, high] = std::minmax(a, b);
  const std::array<int, 2> edge{low, high};
  const auto first =
      std::lower_bound(sides.begin(), sides.end(), edge,
                       [](const TriangleSide& side, const auto& value) { return side.edge < value; });
  auto last = first;
  while (last != sides.end() && last->edge == edge) ++last;
  return {first, last};
}

EdgeComponents edgeComponents(const TriangleMesh& mesh) {
  DisjointSets sets(mesh.triangles.size());
  forEachEdge(sortedSides(mesh), [&](std::span<const TriangleSide> sides) {
    for (const TriangleSide& each : sides) sets.join(sides[0].triangle(), each.triangle());
  });
  EdgeComponents result;
  result.of.resize(mesh.triangles.size());
  for (int t = 0; t < static_cast<int>(mesh.triangles.size()); ++t)
    result.of[t] = sets.of(t) == t ? result.count++ : result.of[sets.of(t)];
  return result;
}

}  // namespace mortier
