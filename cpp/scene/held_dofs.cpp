#include "scene/held_dofs.h"

#include <cmath>

#include "fem/supports.h"
#include "mesh/boundary_line.h"

namespace mortier {

std::optional<int> axisOf(int component, const Point& from, const Point& to) {
  constexpr double aligned = 1e-9;
  if (component == alongX || component == alongY) return component;
  Point along = (to - from).normalized();
  if (component == alongNormal) along = {along.y(), -along.x()};
  if (std::abs(along.y()) < aligned) return 0;
  if (std::abs(along.x()) < aligned) return 1;
  return std::nullopt;
}

std::vector<char> heldDofs(const TriangleMesh& mesh, const std::vector<ConditionDescription>& conditions) {
  std::vector<char> held(2 * mesh.vertices.size(), 0);
  for (const ConditionDescription& condition : conditions) {
    if (condition.kind != ConditionDescription::Kind::displacement) continue;
    if (condition.point) {
      if (condition.component > alongY) continue;
      const int vertex = vertexAt(mesh, *condition.point);
      if (vertex >= 0) held[2 * vertex + condition.component] = 1;
      continue;
    }
    for (const auto& [a, b] : edgesOn(mesh, condition.label)) {
      if (const auto axis = axisOf(condition.component, mesh.vertices[a], mesh.vertices[b]))
        for (const int v : {a, b}) held[2 * v + *axis] = 1;
    }
  }
  return held;
}

}  // namespace mortier
