#include "lint/held_dofs.h"

#include <cmath>

namespace mortier {

std::optional<int> axisOf(const ConditionDescription& condition, const Point& from, const Point& to) {
  constexpr int normal = 2;  // of ConditionDescription::component; beyond it tangential
  constexpr double aligned = 1e-9;
  if (condition.component < normal) return condition.component;
  Point along = (to - from).normalized();
  if (condition.component == normal) along = {along.y(), -along.x()};
  if (std::abs(along.y()) < aligned) return 0;
  if (std::abs(along.x()) < aligned) return 1;
  return std::nullopt;
}

std::vector<char> heldDofs(const TriangleMesh& mesh, const std::vector<ConditionDescription>& conditions) {
  std::vector<char> held(2 * mesh.vertices.size(), 0);
  for (const ConditionDescription& condition : conditions) {
    if (condition.kind != ConditionDescription::Kind::displacement) continue;
    for (size_t e = 0; e < mesh.boundaryEdges.size(); ++e) {
      if (mesh.boundaryLabels[e] != condition.label) continue;
      const auto [a, b] = mesh.boundaryEdges[e];
      if (const auto axis = axisOf(condition, mesh.vertices[a], mesh.vertices[b]))
        for (const int v : {a, b}) held[2 * v + *axis] = 1;
    }
  }
  return held;
}

}  // namespace mortier
