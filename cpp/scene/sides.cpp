#include "scene/sides.h"

#include <optional>
#include <utility>

#include "mesh/boundary_line.h"

namespace mortier {
namespace {

/// Mean length of the edges of a side; none where its mesh or its label is missing.
std::optional<double> meanEdge(const SceneDescription& scene, const SideDescription& side,
                               const std::vector<const TriangleMesh*>& meshes) {
  const TriangleMesh* mesh = meshes[bodyIndex(scene, side.body)];
  if (mesh == nullptr) return std::nullopt;
  double length = 0;
  const auto edges = edgesOn(*mesh, side.label);
  if (edges.empty()) return std::nullopt;
  for (const auto& [a, b] : edges) length += (mesh->vertices[b] - mesh->vertices[a]).norm();
  return length / static_cast<double>(edges.size());
}

}  // namespace

void decideSides(SceneDescription& scene, const std::vector<const TriangleMesh*>& meshes) {
  constexpr double equal = 1e-9;  // then the side named first
  for (ContactDescription& contact : scene.contacts) {
    if (contact.sidesGiven || !contact.choice.empty()) continue;
    const auto first = meanEdge(scene, contact.nonmortar, meshes);
    const auto second = meanEdge(scene, contact.mortar, meshes);
    if (!first || !second) continue;
    const bool secondIsFiner = *second < (1 - equal) * *first;
    const bool alike = !secondIsFiner && *second <= (1 + equal) * *first;
    contact.choice =
        alike ? "both meshes are as fine, nonmortar is the side named first" : "nonmortar is the finer mesh";
    if (contact.otherSide)
      contact.choice = alike ? "both meshes are as fine, nonmortar is the side named last (swap)"
                             : "nonmortar is the coarser mesh (swap)";
    if (secondIsFiner != contact.otherSide) std::swap(contact.nonmortar, contact.mortar);
  }
}

}  // namespace mortier
