#include "scene/resolve.h"

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

double stiffnessRatio(const SceneDescription& scene, const SideDescription& one,
                      const SideDescription& other) {
  const auto young = [&](const SideDescription& side) {
    return scene.bodies[bodyIndex(scene, side.body)].material.elasticity.young;
  };
  return young(one) / young(other);
}

bool farStiffer(const SceneDescription& scene, const ContactDescription& contact, const SideDescription& one,
                const SideDescription& other) {
  constexpr double far = 100;
  return contact.variant != CouplingKind::interpolation && stiffnessRatio(scene, one, other) > far;
}

void decideSides(SceneDescription& scene, const std::vector<const TriangleMesh*>& meshes) {
  constexpr double equal = 1e-9;  // then the side named first
  for (ContactDescription& contact : scene.contacts) {
    if (contact.sidesGiven || !contact.choice.empty()) continue;
    const auto edge1 = meanEdge(scene, contact.nonmortar, meshes);
    const auto edge2 = meanEdge(scene, contact.mortar, meshes);
    if (!edge1 || !edge2) continue;
    const bool secondIsFiner = *edge2 < (1 - equal) * *edge1;
    const bool alike = !secondIsFiner && *edge2 <= (1 + equal) * *edge1;
    contact.choice =
        alike ? "both meshes are as fine, nonmortar is the side named first" : "nonmortar is the finer mesh";
    const bool firstIsStiffer = farStiffer(scene, contact, contact.nonmortar, contact.mortar);
    const bool secondIsStiffer = farStiffer(scene, contact, contact.mortar, contact.nonmortar);
    const bool second = firstIsStiffer || (secondIsFiner && !secondIsStiffer);
    if (firstIsStiffer || secondIsStiffer)
      contact.choice =
          contact.otherSide ? "nonmortar is the far stiffer body (swap)" : "nonmortar is the far softer body";
    else if (contact.otherSide)
      contact.choice = alike ? "both meshes are as fine, nonmortar is the side named last (swap)"
                             : "nonmortar is the coarser mesh (swap)";
    if (second != contact.otherSide) std::swap(contact.nonmortar, contact.mortar);
  }
}

}  // namespace mortier
