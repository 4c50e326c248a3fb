#include <algorithm>
#include <cmath>
#include <map>

#include "base/error.h"
#include "fem/element.h"
#include "material/parts.h"
#include "mesh/boundary_line.h"
#include "scene/build.h"
#include "scene/expression.h"

namespace mortier {

namespace {

/// Where a condition acts: its point, or the vertices of its label, of a traction the middles of edges too.
std::vector<Point> placesOf(const ConditionDescription& condition, const TriangleMesh& mesh) {
  if (condition.point) return {*condition.point};
  std::vector<Point> points;
  if (condition.kind == ConditionDescription::Kind::traction)
    for (const auto& [a, b] : edgesOn(mesh, condition.label))
      points.emplace_back(0.5 * (mesh.vertices[a] + mesh.vertices[b]));
  for (const int v : verticesOn(mesh, condition.label)) points.push_back(mesh.vertices[v]);
  return points;
}

/// Where it acts, over the run: of a value that passes zero only this has digits.
double largestOf(const ConditionDescription& condition, const TriangleMesh& mesh,
                 const std::vector<double>& times) {
  double largest = 0;
  for (const Point& p : placesOf(condition, mesh))
    for (const double t : times) largest = std::max(largest, std::abs(condition.value.value(p[0], p[1], t)));
  return largest;
}

/// Where labels or points meet, all may prescribe a motion of a node, but not differently. `displacements`
/// are the conditions of `supports`, in their order. \throws InputError with node, time [s] and both values
/// [m].
void requireOneDisplacement(const Supports& supports,
                            const std::vector<const ConditionDescription*>& displacements,
                            const TriangleMesh& mesh, const std::vector<double>& times) {
  constexpr double rounding = 1e-9;  // normals of meshed circles are rounded
  std::vector<std::optional<double>> scales(displacements.size());
  const auto scaleOf = [&](int condition) {
    std::optional<double>& scale = scales[condition];
    if (!scale) scale = largestOf(*displacements[condition], mesh, times);
    return *scale;
  };
  for (const FurtherMotion& motion : supports.further()) {
    const NodeSupport& support = supports.nodes()[motion.support];
    const Point& p = mesh.vertices[support.node];
    for (const double t : times) {
      const auto valueOf = [&](int condition) {
        return displacements[condition]->value.value(p[0], p[1], t);
      };
      std::array<double, 2> values{0, 0};
      for (int i = 0; i < support.count; ++i) values[i] = valueOf(support.conditions[i]);
      const double implied = impliedMotion(support, values, motion.direction) + 0.0;  // no -0
      const double off = std::abs(valueOf(motion.condition) - implied);
      if (off == 0) continue;
      double scale = scaleOf(motion.condition);
      for (int i = 0; i < support.count; ++i) scale = std::max(scale, scaleOf(support.conditions[i]));
      if (off <= rounding * scale) continue;
      const auto placeOf = [&](int i) { return nameOfPlace(*displacements[support.conditions[i]]); };
      const int same = sameMotion(support, motion.direction);
      throw InputError(
          displacements[motion.condition]->value.where + " at (" + shortest(p[0]) + ", " + shortest(p[1]) +
          "), t = " + shortest(t) + ": expected the " + shortest(implied) + " that " +
          (same >= 0 ? placeOf(same) + " prescribes" : placeOf(0) + " and " + placeOf(1) + " prescribe") +
          " there");
    }
  }
}

std::shared_ptr<const Material> buildAnisotropic(const MaterialDescription& description, Plane plane,
                                                 const std::vector<double>& angles) {
  const auto* perzyna = description.as<Viscoplasticity>();
  if (perzyna != nullptr && plane == Plane::stress && perzyna->projection != Projection::frobenius)
    throw InputError("expected projection = \"frobenius\" beside elasticity that is not isotropic");
  Anisotropy anisotropy = description.anisotropy->in(plane);
  const bool turnedAlike = angles.size() == 1;
  if (turnedAlike) anisotropy = turned(anisotropy, axesAt(angles[0]));
  MaterialDescription isotropic = description;
  isotropic.anisotropy.reset();
  isotropic.elasticity = stiffestOf(anisotropy);
  return anisotropicMaterial(anisotropy, buildMaterial(isotropic, plane, {}),
                             turnedAlike ? std::vector<double>() : angles);
}

}  // namespace

std::shared_ptr<const Material> buildMaterial(const MaterialDescription& description, Plane plane,
                                              const std::vector<double>& angles) {
  if (description.anisotropy) return buildAnisotropic(description, plane, angles);
  const Elasticity& elasticity = description.elasticity;
  if (const auto* norton = description.as<NortonCreep>()) return nortonMaterial(elasticity, *norton, plane);
  if (const auto* relaxing = description.as<Viscoelasticity>())
    return viscoelasticMaterial(elasticity, *relaxing, plane);
  if (const auto* overstress = description.as<Overstress>())
    return overstressMaterial(elasticity, *overstress, plane);
  if (const auto* own = description.as<OwnLaw>()) return ownMaterial(elasticity, *own, plane);
  if (const auto* perzyna = description.as<Viscoplasticity>())
    return perzynaMaterial(elasticity, *perzyna, plane);
  return elasticMaterial(elasticity, plane);
}

std::shared_ptr<const Material> materialOfRegions(
    const BodyDescription& body, const std::vector<int>& regions, size_t points,
    const std::function<std::shared_ptr<const Material>(const MaterialDescription&)>& make) {
  std::vector<std::shared_ptr<const Material>> materials{make(body.material)};
  std::map<int, int> number;
  for (const RegionDescription& region : body.regions) {
    if (region.material) {
      number[region.label] = static_cast<int>(materials.size());
      materials.push_back(make(*region.material));
    }
  }
  if (materials.size() == 1) return materials.front();
  for (const auto& material : materials)
    if (material->components() != materials.front()->components())
      throw InputError(body.where + ": body " + body.name +
                       ": isotropic_hardening in a part of it, expected it in all regions or in none");
  std::vector<int> materialOf;
  for (const int label : regions) {
    const auto found = number.find(label);
    materialOf.insert(materialOf.end(), points / regions.size(), found == number.end() ? 0 : found->second);
  }
  return materialOfParts(std::move(materials), std::move(materialOf));
}

namespace {

void addInitialStress(const StressDescription& stress, std::optional<int> region, const TriangleMesh& mesh,
                      Conditions& conditions) {
  for (size_t c = 0; c < stress.size(); ++c) {
    if (!stress[c]) continue;
    requireFinite(*stress[c], centresOf(mesh), {0});
    conditions.initialStresses.push_back({static_cast<int>(c), region, finiteValue(*stress[c])});
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

Body buildTool(const BodyDescription& tool, TriangleMesh mesh, const SceneDescription& scene,
               const std::vector<double>& times) {
  const bool axisymmetric = scene.plane == Plane::axisymmetric;
  RigidMotion motion{*tool.reference, {}, {}};
  for (const ConditionDescription& c : tool.conditions) {
    requireFinite(c.value, std::vector<Point>{motion.at}, times);
    const bool held = c.kind == ConditionDescription::Kind::displacement;
    (held ? motion.held : motion.force)[c.component] = finiteValue(c.value);
  }
  motion.turns = tool.turns() && isFollowed(scene, tool.name);
  Conditions conditions;
  conditions.rigid = std::move(motion);
  return {tool.name,    std::move(mesh), buildMaterial(tool.material, scene.plane), std::move(conditions),
          scene.degree, axisymmetric};
}

}  // namespace

Body buildBody(const BodyDescription& body, TriangleMesh mesh, const SceneDescription& scene,
               const std::vector<double>& times) {
  if (body.isTool()) return buildTool(body, std::move(mesh), scene, times);
  const bool axisymmetric = scene.plane == Plane::axisymmetric;
  if (axisymmetric) mesh = meshAboutAxis(std::move(mesh));
  Conditions conditions;
  std::vector<const ConditionDescription*> displacements;
  for (const ConditionDescription& c : body.conditions) {
    requireFinite(c.value, placesOf(c, mesh), times);
    if (c.kind == ConditionDescription::Kind::displacement) {
      conditions.displacements.push_back({c.label, c.component, finiteValue(c.value), c.point});
      displacements.push_back(&c);
    } else {
      conditions.tractions.push_back({c.label, c.component, finiteValue(c.value)});
    }
  }
  for (const int c : {0, 1}) {
    if (!body.force[c]) continue;
    requireFinite(*body.force[c], centresOf(mesh), times);
    conditions.forces.push_back({c, finiteValue(*body.force[c])});
  }
  addInitialStress(body.initialStress, std::nullopt, mesh, conditions);
  for (const RegionDescription& region : body.regions)
    addInitialStress(region.initialStress, region.label, mesh, conditions);
  requireOneDisplacement(mesh, conditions.displacements, displacements, axisymmetric, times);
  const std::vector<Point> places = placesOfPoints(mesh, elementNodes(mesh, scene.degree));
  const std::shared_ptr<const Material> material =
      materialOfRegions(body, mesh.regions, places.size(), [&](const MaterialDescription& description) {
        return buildMaterial(description, scene.plane, anglesOf(description, places));
      });
  if (body.temperature) {
    conditions.temperature = finiteValue(body.temperature->value);
    conditions.expansion = expansionOf(body, mesh, scene.plane, places, times);
  }
  return {body.name,
          std::move(mesh),
          material,
          std::move(conditions),
          scene.degree,
          axisymmetric,
          body.volume == Volume::averaged};
}

}  // namespace mortier
