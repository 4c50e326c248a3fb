#include "scene/resolve.h"

#include <algorithm>
#include <array>
#include <utility>

#include "base/digits.h"
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

/// The length of the nearest mortar edge over that of a nonmortar edge, which two fifths of the nonmortar
/// edges exceed: a graded line has about as many edges in its fine part, where contact is expected.
/// Both sides have edges.
double edgeRatio(const TriangleMesh& nonmortar, int label, const TriangleMesh& mortar, int mortarLabel) {
  constexpr size_t enough = 1000;
  const auto edges = edgesOn(nonmortar, label);
  const auto others = edgesOn(mortar, mortarLabel);
  std::vector<double> ratios;
  for (size_t e = 0; e < edges.size(); e += 1 + edges.size() / enough) {
    const Point& from = nonmortar.vertices[edges[e][0]];
    const Point& to = nonmortar.vertices[edges[e][1]];
    const auto distance = [&](const std::array<int, 2>& other) {
      return (mortar.vertices[other[0]] + mortar.vertices[other[1]] - from - to).squaredNorm();
    };
    const auto& [a, b] =
        *std::min_element(others.begin(), others.end(),
                          [&](const auto& one, const auto& two) { return distance(one) < distance(two); });
    ratios.push_back((mortar.vertices[b] - mortar.vertices[a]).norm() / (to - from).norm());
  }
  const auto exceeded = ratios.begin() + static_cast<std::ptrdiff_t>(3 * ratios.size() / 5);
  std::nth_element(ratios.begin(), exceeded, ratios.end());
  return *exceeded;
}

}  // namespace

double stiffnessRatio(const SceneDescription& scene, const SideDescription& one,
                      const SideDescription& other) {
  const auto young = [&](const SideDescription& side) {
    return scene.bodies[bodyIndex(scene, side.body)].material.elasticity.young;
  };
  return young(one) / young(other);
}

bool stiffer(const SceneDescription& scene, const ContactDescription& contact, const SideDescription& one,
             const SideDescription& other, double times) {
  return contact.variant != CouplingKind::interpolation && stiffnessRatio(scene, one, other) > times;
}

void decideSides(SceneDescription& scene, const std::vector<const TriangleMesh*>& meshes) {
  constexpr double equal = 1e-9;  // then the side named first
  constexpr double far = 100;     // a coarse soft side may touch between its nodes
  for (ContactDescription& contact : scene.contacts) {
    if (contact.sidesGiven || !contact.choice.empty()) continue;
    const auto edge1 = meanEdge(scene, contact.nonmortar, meshes);
    const auto edge2 = meanEdge(scene, contact.mortar, meshes);
    if (!edge1 || !edge2) continue;
    const bool secondIsFiner = *edge2 < (1 - equal) * *edge1;
    const bool alike = !secondIsFiner && *edge2 <= (1 + equal) * *edge1;
    contact.choice =
        alike ? "both meshes are as fine, nonmortar is the side named first" : "nonmortar is the finer mesh";
    const bool firstIsStiffer = stiffer(scene, contact, contact.nonmortar, contact.mortar, far);
    const bool secondIsStiffer = stiffer(scene, contact, contact.mortar, contact.nonmortar, far);
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

std::optional<Alternation> alternation(const SceneDescription& scene, const ContactDescription& contact,
                                       const std::vector<const TriangleMesh*>& meshes) {
  // Nodal pressures are off by more than 2 % beyond one of these pairs, at degree 2 beyond the first one
  // (docs/measurements.md): the least ratio of nodes, and of nodes times stiffness.
  constexpr double limits[][2] = {{1.1, 4}, {1.5, 1.25}};
  const auto edgesOf = [&](const SideDescription& side) {
    return meanEdge(scene, side, meshes).has_value() ? meshes[bodyIndex(scene, side.body)] : nullptr;
  };
  const TriangleMesh* nonmortar = edgesOf(contact.nonmortar);
  const TriangleMesh* mortar = edgesOf(contact.mortar);
  if (nonmortar == nullptr || mortar == nullptr || contact.variant == CouplingKind::interpolation)
    return std::nullopt;
  const double edges = edgeRatio(*nonmortar, contact.nonmortar.label, *mortar, contact.mortar.label);
  const double nodes = edges / (rowDegree(contact.variant, scene.degree) < scene.degree ? 2 : 1);
  const double stiffness = stiffnessRatio(scene, contact.nonmortar, contact.mortar);
  const auto beyond = [&](const auto& limit) { return nodes > limit[0] && nodes * stiffness > limit[1]; };
  if (beyond(limits[0]) || (scene.degree == 1 && beyond(limits[1]))) return Alternation{edges, stiffness};
  return std::nullopt;
}

void decideVariants(SceneDescription& scene, const std::vector<const TriangleMesh*>& meshes) {
  if (scene.accuracy.bound || scene.accuracy.asked() > 0) return;
  for (ContactDescription& contact : scene.contacts) {
    if (contact.variantGiven || !stiffer(scene, contact, contact.nonmortar, contact.mortar)) continue;
    const auto found = alternation(scene, contact, meshes);
    if (!found) continue;
    contact.variantGiven = true;
    contact.variant = CouplingKind::coarsened;
    contact.choice += (contact.choice.empty() ? "" : ", ") + std::string("fewer nodes as its edges are ") +
                      digits(found->edges) + " times as short and its young is " + digits(found->stiffness) +
                      " times as large";
  }
}

}  // namespace mortier
