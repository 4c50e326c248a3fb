#include "scene/build_body.h"

#include <map>

#include "fem/element.h"
#include "material/parts.h"
#include "scene/check_data.h"
#include "scene/finite_value.h"

namespace mortier {

namespace {

std::shared_ptr<const Material> buildMaterial(const MaterialDescription& description, Plane plane) {
  const Elasticity& elasticity = description.elasticity;
  if (const auto* norton = description.as<NortonCreep>()) return nortonMaterial(elasticity, *norton, plane);
  if (const auto* viscoelasticity = description.as<Viscoelasticity>())
    return viscoelasticMaterial(elasticity, *viscoelasticity, plane);
  const auto* viscoplasticity = description.as<Viscoplasticity>();
  if (plane != Plane::stress) {
    return viscoplasticity ? planeStrainPerzynaMaterial(elasticity, *viscoplasticity)
                           : planeStrainElasticMaterial(elasticity);
  }
  return viscoplasticity ? perzynaMaterial(elasticity, *viscoplasticity) : elasticMaterial(elasticity);
}

/// One material, or as many as regions ask for.
std::shared_ptr<const Material> buildMaterial(const BodyDescription& body, const TriangleMesh& mesh,
                                              Plane plane, int pointsOfATriangle) {
  std::vector<std::shared_ptr<const Material>> materials{buildMaterial(body.material, plane)};
  std::map<int, int> number;
  for (const RegionDescription& region : body.regions) {
    if (region.material) {
      number[region.label] = static_cast<int>(materials.size());
      materials.push_back(buildMaterial(*region.material, plane));
    }
  }
  if (materials.size() == 1) {
    return materials.front();
  }
  std::vector<int> materialOf;
  for (const int label : mesh.regions) {
    const auto found = number.find(label);
    materialOf.insert(materialOf.end(), pointsOfATriangle, found == number.end() ? 0 : found->second);
  }
  return materialOfParts(std::move(materials), std::move(materialOf));
}

void addInitialStress(const StressDescription& stress, std::optional<int> region, Conditions& conditions) {
  for (size_t c = 0; c < stress.size(); ++c) {
    if (stress[c]) {
      conditions.initialStresses.push_back({static_cast<int>(c), region, finiteValue(*stress[c])});
    }
  }
}

/// Data that meet at a node agree, with the axis too.
void requireOneDisplacement(const TriangleMesh& mesh, std::vector<PrescribedDisplacement> prescribed,
                            std::vector<const ConditionDescription*> described, bool axisymmetric,
                            const std::vector<double>& times) {
  ConditionDescription axis;
  axis.onAxis = true;
  if (axisymmetric) {
    axis.value.value = heldOnAxis().value;
    prescribed.insert(prescribed.begin(), heldOnAxis());
    described.insert(described.begin(), &axis);
  }
  requireOneDisplacement(Supports(mesh, prescribed), described, mesh, times);
}

}  // namespace

Body buildBody(const BodyDescription& body, TriangleMesh mesh, const SceneDescription& scene,
               const std::vector<double>& times) {
  Conditions conditions;
  std::vector<const ConditionDescription*> displacements;
  for (const ConditionDescription& c : body.conditions) {
    if (c.kind == ConditionDescription::Kind::displacement) {
      conditions.displacements.push_back({c.label, c.component, finiteValue(c.value), c.point});
      displacements.push_back(&c);
    } else {
      conditions.tractions.push_back({c.label, c.component, finiteValue(c.value)});
    }
  }
  const bool axisymmetric = scene.plane == Plane::axisymmetric;
  if (axisymmetric) mesh = meshAboutAxis(std::move(mesh));
  requireFiniteData(body, mesh, times);
  requireOneDisplacement(mesh, conditions.displacements, displacements, axisymmetric, times);
  for (const int c : {0, 1}) {
    if (body.force[c]) {
      conditions.forces.push_back({c, finiteValue(*body.force[c])});
    }
  }
  addInitialStress(body.initialStress, std::nullopt, conditions);
  for (const RegionDescription& region : body.regions) {
    addInitialStress(region.initialStress, region.label, conditions);
  }
  const int points = withElement(scene.degree, [](auto element) { return decltype(element)::points; });
  const std::shared_ptr<const Material> material = buildMaterial(body, mesh, scene.plane, points);
  return {body.name, std::move(mesh), material, std::move(conditions), scene.degree, axisymmetric};
}

}  // namespace mortier
