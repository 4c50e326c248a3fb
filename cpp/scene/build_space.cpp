// Bodies in space from a resolved scene.
#include <algorithm>
#include <cmath>

#include "base/error.h"
#include "scene/build.h"
#include "scene/expression.h"

namespace mortier {
namespace {

/// The vertices of a label, and the middles of its triangles.
std::vector<SpacePoint> placesOn(const TetrahedronMesh& mesh, int label) {
  std::vector<SpacePoint> places;
  for (const int v : verticesOn(mesh, label)) places.push_back(mesh.vertices[v]);
  for (const auto& [a, b, c] : trianglesOn(mesh, label))
    places.emplace_back((mesh.vertices[a] + mesh.vertices[b] + mesh.vertices[c]) / 3);
  return places;
}

/// Where conditions meet, all may prescribe a motion of a node along an axis, but not differently.
/// \throws InputError with node, time [s] and both values [m].
void requireOneMotion(const BodyDescription& description, const Body& body,
                      const std::vector<double>& times) {
  constexpr double rounding = 1e-9;
  const SpaceNodes& nodes = body.space()->nodes();
  const std::vector<int>& labels = body.space()->mesh().boundaryLabels;
  for (const double t : times) {
    Vector u = Vector::Zero(body.dofs());
    body.prescribe(t, u);
    const double largest = u.cwiseAbs().maxCoeff();
    for (const ConditionDescription& condition : description.conditions) {
      if (condition.kind != ConditionDescription::Kind::displacement || condition.pointInSpace ||
          condition.component == spaceNormal)
        continue;
      const SpaceDatum value = finiteInSpace(condition.value);
      for (size_t i = 0; i < nodes.faces.size(); ++i)
        for (int a = 0; a < nodes.perFace() && labels[i] == condition.label; ++a) {
          const int node = nodes.faces[i][a];
          const SpacePoint& x = nodes.places[node];
          const double held = u[3 * static_cast<Eigen::Index>(node) + condition.component];
          const double wanted = value(x, t);
          if (std::abs(held - wanted) <= rounding * std::max(largest, std::abs(wanted))) continue;
          throw InputError(condition.value.where + " at " + shortest(x) + ", t = " + shortest(t) +
                           ": expected the " + shortest(held) + " that other conditions prescribe there");
        }
    }
  }
}

}  // namespace

Body buildSpaceBody(const BodyDescription& description, TetrahedronMesh mesh, const SceneDescription& scene,
                    const std::vector<double>& times) {
  SpaceConditions conditions;
  for (const ConditionDescription& c : description.conditions) {
    requireFinite(c.value,
                  c.pointInSpace ? std::vector<SpacePoint>{*c.pointInSpace} : placesOn(mesh, c.label), times);
    const bool held = c.kind == ConditionDescription::Kind::displacement;
    (held ? conditions.displacements : conditions.tractions)
        .push_back({c.label, c.component, finiteInSpace(c.value), c.pointInSpace});
  }
  for (int c = 0; c < 3; ++c) {
    if (!description.force[c]) continue;
    requireFinite(*description.force[c], centresOf(mesh), times);
    conditions.forces.push_back({0, c, finiteInSpace(*description.force[c])});
  }
  const auto addStress = [&](const StressDescription& stress, std::optional<int> region) {
    for (size_t c = 0; c < stress.size(); ++c) {
      if (!stress[c]) continue;
      requireFinite(*stress[c], centresOf(mesh), {0});
      conditions.initialStresses.push_back({static_cast<int>(c), region, finiteInSpace(*stress[c])});
    }
  };
  addStress(description.initialStress, std::nullopt);
  for (const RegionDescription& region : description.regions) addStress(region.initialStress, region.label);
  const std::vector<SpacePoint> places = placesOfPoints(mesh, scene.degree);
  const auto material =
      materialOfRegions(description, mesh.regions, places.size(), [&](const MaterialDescription& each) {
        return buildMaterial(each, Plane::none, anglesOf(each, places));
      });
  if (description.temperature) {
    conditions.temperature = finiteInSpace(description.temperature->value);
    conditions.expansion = expansionOf(description, mesh, Plane::none, places, times);
  }
  Body body(description.name, std::move(mesh), material, std::move(conditions), scene.degree,
            description.volume == Volume::averaged);
  requireOneMotion(description, body, times);
  return body;
}

}  // namespace mortier
