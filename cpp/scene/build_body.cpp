#include "scene/build_body.h"

#include <map>
#include <sstream>

#include "material/parts.h"
#include "scene/check_data.h"

namespace mortier {

namespace {

std::shared_ptr<const Material> buildMaterial(const MaterialDescription& description, Plane plane) {
  const auto& [elasticity, viscoplasticity] = description;
  if (plane == Plane::strain) {
    return viscoplasticity ? planeStrainPerzynaMaterial(elasticity, *viscoplasticity)
                           : planeStrainElasticMaterial(elasticity);
  }
  return viscoplasticity ? perzynaMaterial(elasticity, *viscoplasticity) : elasticMaterial(elasticity);
}

/// One material, or as many as regions ask for.
std::shared_ptr<const Material> buildMaterial(const BodyDescription& body, const TriangleMesh& mesh,
                                              Plane plane) {
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
    materialOf.push_back(found == number.end() ? 0 : found->second);
  }
  return materialOfParts(std::move(materials), std::move(materialOf));
}

void addInitialStress(const StressDescription& stress, std::optional<int> region, Conditions& conditions) {
  for (size_t c = 0; c < stress.size(); ++c) {
    if (stress[c]) {
      conditions.initialStresses.push_back({static_cast<int>(c), region, stress[c]->value});
    }
  }
}

/// Thin triangles spoil the accuracy: told with their number and the worst.
void warnOfThinTriangles(const BodyDescription& body, const TriangleMesh& mesh,
                         std::vector<std::string>& warnings) {
  constexpr double thin = 30;  // its smallest angle is about 2 degrees or less
  int count = 0;
  int worst = 0;
  for (int t = 0; t < static_cast<int>(mesh.triangles.size()); ++t) {
    count += aspectRatio(mesh, t) > thin ? 1 : 0;
    if (aspectRatio(mesh, t) > aspectRatio(mesh, worst)) {
      worst = t;
    }
  }
  if (count == 0) {
    return;
  }
  std::ostringstream text;
  text.precision(3);
  text << body.meshWhere << ": body " << body.name << ": " << count << " of " << mesh.triangles.size()
       << " triangles of " << mesh.name << " are thin; the worst is triangle " << worst + 1
       << ", aspect ratio " << aspectRatio(mesh, worst);
  warnings.push_back(text.str());
}

}  // namespace

Body buildBody(const BodyDescription& body, TriangleMesh mesh, Plane plane, const std::vector<double>& times,
               std::vector<std::string>& warnings) {
  warnOfThinTriangles(body, mesh, warnings);
  Conditions conditions;
  std::vector<const ConditionDescription*> displacements;
  for (const ConditionDescription& c : body.conditions) {
    if (c.kind == ConditionDescription::Kind::displacement) {
      conditions.displacements.push_back({c.label, c.component, c.value.value});
      displacements.push_back(&c);
    } else {
      conditions.tractions.push_back({c.label, c.component, c.value.value});
    }
  }
  requireFiniteData(body, mesh, times);
  requireOneDisplacement(Supports(mesh, conditions.displacements), displacements, mesh, times);
  for (const int c : {0, 1}) {
    if (body.force[c]) {
      conditions.forces.push_back({c, body.force[c]->value});
    }
  }
  addInitialStress(body.initialStress, std::nullopt, conditions);
  for (const RegionDescription& region : body.regions) {
    addInitialStress(region.initialStress, region.label, conditions);
  }
  const std::shared_ptr<const Material> material = buildMaterial(body, mesh, plane);
  return {body.name, std::move(mesh), material, std::move(conditions)};
}

}  // namespace mortier
