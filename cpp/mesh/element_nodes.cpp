#include "mesh/element_nodes.h"

#include <algorithm>
#include <unordered_map>

namespace mortier {

ElementNodes elementNodes(const TriangleMesh& mesh, int degree) {
  ElementNodes nodes;
  nodes.degree = degree;
  nodes.places = mesh.vertices;
  const size_t edges = mesh.boundaryEdges.size();
  if (degree == 1) {
    nodes.elements.reserve(3 * mesh.triangles.size());
    for (const auto& t : mesh.triangles) nodes.elements.insert(nodes.elements.end(), t.begin(), t.end());
    for (size_t e = 0; e < edges; ++e) nodes.boundary.push_back({mesh.boundaryEdges[e], static_cast<int>(e)});
    return nodes;
  }
  const auto key = [&](int a, int b) {
    const auto [low, high] = std::minmax(a, b);
    return static_cast<int64_t>(low) * static_cast<int64_t>(mesh.vertices.size()) + high;
  };
  std::unordered_map<int64_t, int> middleOf;
  nodes.elements.reserve(6 * mesh.triangles.size());
  for (const auto& t : mesh.triangles) {
    nodes.elements.insert(nodes.elements.end(), t.begin(), t.end());
    for (int side = 0; side < 3; ++side) {
      const int a = t[side];
      const int b = t[(side + 1) % 3];
      const auto [found, isNew] = middleOf.try_emplace(key(a, b), nodes.count());
      if (isNew) nodes.places.emplace_back((mesh.vertices[a] + mesh.vertices[b]) / 2);
      nodes.elements.push_back(found->second);
    }
  }
  for (size_t e = 0; e < edges; ++e) {
    const auto& [a, b] = mesh.boundaryEdges[e];
    const int middle = middleOf.at(key(a, b));
    nodes.middles.push_back(middle);
    if (!mesh.edgeMiddles.empty() && mesh.edgeMiddles[e].allFinite())
      nodes.places[middle] = mesh.edgeMiddles[e];
    nodes.boundary.push_back({{a, middle}, static_cast<int>(e)});
    nodes.boundary.push_back({{middle, b}, static_cast<int>(e)});
  }
  return nodes;
}

}  // namespace mortier
