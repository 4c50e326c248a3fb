#include "scene/build_body.h"

#include <map>

#include "base/error.h"
#include "fem/element.h"
#include "material/parts.h"
#include "scene/build_temperature.h"
#include "scene/check_data.h"
#include "scene/finite_value.h"

namespace mortier {

namespace {

/// Elasticity that is not isotropic, turned at every one of the places where its angle varies.
std::shared_ptr<const Material> buildAnisotropic(const MaterialDescription& description, Plane plane,
                                                 const std::vector<Point>& places) {
  const AnisotropyDescription& own = *description.anisotropy;
  StressLaw flow;
  if (const auto* perzyna = description.as<Viscoplasticity>()) flow = *perzyna;
  if (const auto* norton = description.as<NortonCreep>()) flow = *norton;
  const Anisotropy anisotropy = own.in(plane);
  if (!own.angle) return anisotropicMaterial(anisotropy, flow, plane);
  requireFinite(*own.angle, places, {0});
  if (own.angle->constant)
    return anisotropicMaterial(turned(anisotropy, own.angle->value(0, 0, 0)), flow, plane);
  std::vector<double> angles;
  for (const Point& place : places) angles.push_back(own.angle->value(place.x(), place.y(), 0));
  return turnedMaterial(anisotropicMaterial(anisotropy, flow, plane), angles);
}

}  // namespace

std::shared_ptr<const Material> buildMaterial(const MaterialDescription& description, Plane plane,
                                              const std::vector<Point>& places) {
  if (description.anisotropy) return buildAnisotropic(description, plane, places);
  const Elasticity& elasticity = description.elasticity;
  if (const auto* norton = description.as<NortonCreep>()) return nortonMaterial(elasticity, *norton, plane);
  if (const auto* viscoelasticity = description.as<Viscoelasticity>())
    return viscoelasticMaterial(elasticity, *viscoelasticity, plane);
  if (const auto* overstress = description.as<Overstress>())
    return overstressMaterial(elasticity, *overstress, plane);
  if (const auto* own = description.as<OwnLaw>()) return ownMaterial(elasticity, *own, plane);
  const auto* viscoplasticity = description.as<Viscoplasticity>();
  if (plane != Plane::stress) {
    return viscoplasticity ? planeStrainPerzynaMaterial(elasticity, *viscoplasticity)
                           : planeStrainElasticMaterial(elasticity);
  }
  return viscoplasticity ? perzynaMaterial(elasticity, *viscoplasticity) : elasticMaterial(elasticity);
}

namespace {

/// One material, or as many as regions ask for.
std::shared_ptr<const Material> buildMaterial(const BodyDescription& body, const TriangleMesh& mesh,
                                              Plane plane, const std::vector<Point>& places) {
  std::vector<std::shared_ptr<const Material>> materials{buildMaterial(body.material, plane, places)};
  std::map<int, int> number;
  for (const RegionDescription& region : body.regions) {
    if (region.material) {
      number[region.label] = static_cast<int>(materials.size());
      materials.push_back(buildMaterial(*region.material, plane, places));
    }
  }
  if (materials.size() == 1) {
    return materials.front();
  }
  for (const auto& material : materials)
    if (material->components() != materials.front()->components())
      throw InputError(body.where + ": body " + body.name +
                       ": isotropic_hardening in a part of it, expected it in all regions or in none");
  std::vector<int> materialOf;
  for (const int label : mesh.regions) {
    const auto found = number.find(label);
    materialOf.insert(materialOf.end(), places.size() / mesh.regions.size(),
                      found == number.end() ? 0 : found->second);
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
  const std::vector<Point> places = placesOfPoints(mesh, elementNodes(mesh, scene.degree));
  const std::shared_ptr<const Material> material = buildMaterial(body, mesh, scene.plane, places);
  addTemperature(body, mesh, scene.plane, places, times, conditions);
  return {body.name, std::move(mesh), material, std::move(conditions), scene.degree, axisymmetric};
}

}  // namespace mortier
