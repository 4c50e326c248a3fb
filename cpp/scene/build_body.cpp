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

/// Its point in the plane or in space.
template <class Place>
const std::optional<Place>& pointOf(const ConditionDescription& condition) {
  if constexpr (std::is_same_v<Place, Point>)
    return condition.point;
  else
    return condition.pointInSpace;
}

/// Where a condition acts: its point, or the vertices of its label, of a traction the middles of sides too.
template <class Mesh>
auto placesOf(const ConditionDescription& condition, const Mesh& mesh) {
  using Place = typename decltype(mesh.vertices)::value_type;
  if (const auto& point = pointOf<Place>(condition)) return std::vector<Place>{*point};
  std::vector<Place> places;
  if (condition.kind == ConditionDescription::Kind::traction)
    for (const auto& side : sidesWith(mesh, condition.label)) {
      Place sum = Place::Zero();
      for (const int v : side) sum += mesh.vertices[v];
      places.push_back(sum / static_cast<double>(side.size()));
    }
  for (const int v : verticesOn(mesh, condition.label)) places.push_back(mesh.vertices[v]);
  return places;
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

template <class Mesh>
Body buildTool(const BodyDescription& tool, Mesh mesh, const SceneDescription& scene,
               const std::vector<double>& times) {
  constexpr bool inSpace = std::is_same_v<Mesh, TetrahedronMesh>;
  RigidMotion motion{*tool.reference, {}, {}};
  for (const ConditionDescription& c : tool.conditions) {
    requireFinite(c.value, std::vector<SpacePoint>{motion.at}, times);
    const bool held = c.kind == ConditionDescription::Kind::displacement;
    motion.held.push_back(held ? finiteValue(c.value, inSpace) : Datum());
    motion.force.push_back(held ? Datum() : finiteValue(c.value, inSpace));
    motion.whereItIs.push_back(c.whereItIs);
  }
  motion.surface = !tool.point;
  motion.turns = tool.turns() && isFollowed(scene, tool.name);
  Conditions conditions;
  conditions.rigid = std::move(motion);
  std::shared_ptr<const Material> material =
      buildMaterial(tool.material, inSpace ? Plane::none : scene.plane);
  if constexpr (inSpace)
    return {tool.name, std::move(mesh), std::move(material), std::move(conditions), scene.degree};
  else
    return {tool.name,           std::move(mesh),
            std::move(material), std::move(conditions),
            scene.degree,        scene.plane == Plane::axisymmetric};
}

/// Where labels or points meet, all may prescribe a motion of a node, but not differently. `described` are
/// the conditions of the body's supports, in their order; the axis is none of them. \throws InputError with
/// node, time [s] and both values [m].
void requireOneDisplacement(const Body& body, std::vector<const ConditionDescription*> described,
                            const std::vector<double>& times) {
  constexpr double rounding = 1e-9;  // normals of meshed circles are rounded
  ConditionDescription axis;
  axis.onAxis = true;
  if (body.axisymmetric()) described.insert(described.begin(), &axis);
  const std::vector<Condition>& conditions = body.conditions().displacements;
  const Supports& supports = body.supports();
  // The largest value of each over the run: of one that passes zero only this has digits.
  std::vector<std::optional<double>> scales(conditions.size());
  const auto scaleOf = [&](int condition) {
    std::optional<double>& scale = scales[condition];
    if (scale) return *scale;
    scale = 0;
    const auto add = [&](const SpacePoint& place) {
      for (const double t : times) scale = std::max(*scale, std::abs(conditions[condition].value(place, t)));
    };
    for (const NodeSupport& support : supports.nodes())
      if (std::ranges::find(support.conditions, condition) != support.conditions.end()) add(support.place);
    for (const FurtherMotion& motion : supports.further())
      if (motion.condition == condition) add(supports.nodes()[motion.support].place);
    return *scale;
  };
  for (const FurtherMotion& motion : supports.further()) {
    const NodeSupport& support = supports.nodes()[motion.support];
    const SpacePoint& p = support.place;
    const auto staysWhereItIs = [&](int condition) { return described[condition]->whereItIs; };
    if (staysWhereItIs(motion.condition) ||
        std::any_of(support.conditions.begin(), support.conditions.begin() + support.count, staysWhereItIs))
      continue;
    for (const double t : times) {
      std::array<double, 3> values{};
      for (int i = 0; i < support.count; ++i) values[i] = conditions[support.conditions[i]].value(p, t);
      const double implied = support.implied(values, motion.direction) + 0.0;  // no -0
      const double off = std::abs(conditions[motion.condition].value(p, t) - implied);
      if (off == 0) continue;
      double scale = scaleOf(motion.condition);
      for (int i = 0; i < support.count; ++i) scale = std::max(scale, scaleOf(support.conditions[i]));
      if (off <= rounding * scale) continue;
      std::string who;
      const int same = support.same(motion.direction);
      for (int i = same < 0 ? 0 : same; i < (same < 0 ? support.count : same + 1); ++i)
        who += (who.empty() ? "" : " and ") + nameOfPlace(*described[support.conditions[i]]);
      throw InputError(described[motion.condition]->value.where + " at (" + shortest(p[0]) + ", " +
                       shortest(p[1]) + (body.dimension() == 3 ? ", " + shortest(p[2]) : "") +
                       "), t = " + shortest(t) + ": expected the " + shortest(implied) + " that " + who +
                       (same < 0 && support.count > 1 ? " prescribe" : " prescribes") + " there");
    }
  }
}

}  // namespace

template <class Mesh>
Body buildBody(const BodyDescription& body, Mesh mesh, const SceneDescription& scene,
               const std::vector<double>& times) {
  constexpr bool inSpace = std::is_same_v<Mesh, TetrahedronMesh>;
  using Place = typename decltype(mesh.vertices)::value_type;
  const Plane plane = inSpace ? Plane::none : scene.plane;
  if (body.isTool()) return buildTool(body, std::move(mesh), scene, times);
  if constexpr (!inSpace)
    if (plane == Plane::axisymmetric) mesh = meshAboutAxis(std::move(mesh));
  Conditions conditions;
  std::vector<const ConditionDescription*> displacements;
  for (const ConditionDescription& c : body.conditions) {
    requireFinite(c.value, placesOf(c, mesh), times);
    const bool held = c.kind == ConditionDescription::Kind::displacement;
    Condition condition{c.label, c.component, finiteValue(c.value, inSpace), c.pointInSpace};
    if (c.point) condition.point = asSpacePoint(*c.point);
    if (condition.point) condition.label = -1;  // of no boundary
    condition.whereItIs = c.whereItIs;
    (held ? conditions.displacements : conditions.tractions).push_back(std::move(condition));
    if (held) displacements.push_back(&c);
  }
  for (int c = 0; c < (inSpace ? 3 : 2); ++c) {
    if (!body.force[c]) continue;
    requireFinite(*body.force[c], centresOf(mesh), times);
    conditions.forces.push_back({c, finiteValue(*body.force[c], inSpace)});
  }
  const auto addStress = [&](const StressDescription& stress, std::optional<int> region) {
    for (size_t c = 0; c < stress.size(); ++c) {
      if (!stress[c]) continue;
      requireFinite(*stress[c], centresOf(mesh), {0});
      conditions.initialStresses.push_back({static_cast<int>(c), region, finiteValue(*stress[c], inSpace)});
    }
  };
  addStress(body.initialStress, std::nullopt);
  for (const RegionDescription& region : body.regions) addStress(region.initialStress, region.label);
  const std::vector<Place> places = placesOfPoints(mesh, scene.degree);
  const std::shared_ptr<const Material> material =
      materialOfRegions(body, mesh.regions, places.size(), [&](const MaterialDescription& description) {
        return buildMaterial(description, plane, anglesOf(description, places));
      });
  if (body.temperature) {
    conditions.temperature = finiteValue(body.temperature->value, inSpace);
    conditions.expansion = expansionOf(body, mesh, plane, places, times);
  }
  const bool averaged = body.volume == Volume::averaged;
  const auto built = [&] {
    if constexpr (inSpace)
      return Body(body.name, std::move(mesh), material, std::move(conditions), scene.degree, averaged);
    else
      return Body(body.name, std::move(mesh), material, std::move(conditions), scene.degree,
                  plane == Plane::axisymmetric, averaged);
  };
  Body result = built();
  requireOneDisplacement(result, std::move(displacements), times);
  return result;
}

template Body buildBody(const BodyDescription&, TriangleMesh, const SceneDescription&,
                        const std::vector<double>&);
template Body buildBody(const BodyDescription&, TetrahedronMesh, const SceneDescription&,
                        const std::vector<double>&);

}  // namespace mortier
