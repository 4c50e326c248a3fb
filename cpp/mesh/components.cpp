#include "mesh/components.h"

#include "base/disjoint_sets.h"
#include "mesh/triangle_sides.h"

namespace mortier {

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
