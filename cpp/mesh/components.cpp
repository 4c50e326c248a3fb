#include "mesh/components.h"

#include <numeric>

#include "base/disjoint_sets.h"

namespace mortier {
EdgeComponents edgeComponents(const TriangleMesh& mesh) {
  const auto triangles = static_cast<int>(mesh.triangles.size());
  std::vector<int> first(mesh.vertices.size() + 1, 0);
  for (const auto& triangle : mesh.triangles)
    for (const int v : triangle) ++first[v + 1];
  std::partial_sum(first.begin(), first.end(), first.begin());
  std::vector<int> around(3 * mesh.triangles.size());
  std::vector<int> next(first.begin(), first.end() - 1);
  for (int t = 0; t < triangles; ++t)
    for (const int v : mesh.triangles[t]) around[next[v]++] = t;

  DisjointSets sets(mesh.triangles.size());
  std::vector<int> seenAround(mesh.vertices.size(), -1);  // the vertex around which an end of an edge was met
  std::vector<int> seenBy(mesh.vertices.size(), 0);       // and its triangle
  for (int v = 0; v < static_cast<int>(mesh.vertices.size()); ++v)
    for (int i = first[v]; i < first[v + 1]; ++i)
      for (const int other : mesh.triangles[around[i]]) {
        if (other == v) continue;
        if (seenAround[other] == v) sets.join(seenBy[other], around[i]);
        seenAround[other] = v;
        seenBy[other] = around[i];
      }
  EdgeComponents result;
  result.of.resize(mesh.triangles.size());
  for (int t = 0; t < triangles; ++t) result.of[t] = sets.of(t) == t ? result.count++ : result.of[sets.of(t)];
  return result;
}

}  // namespace mortier
