#include "scene/build.h"

#include <algorithm>
#include <cmath>
#include <map>
#include <set>
#include <sstream>

#include "base/error.h"
#include "material/parts.h"
#include "mesh/read.h"
#include "scene/document.h"
#include "scene/schema.h"

namespace mortier {

namespace {

using Kind = ConditionDescription::Kind;

/// Where data are tried before the run: the ends of the first and last step, and between.
std::vector<double> sampleTimes(const TimePlan& plan) {
  const double step = plan.end / (plan.steps > 0 ? plan.steps : 100);
  return {0, step, 0.5 * plan.end, plan.end - step, plan.end};
}

void requireLabel(const TriangleMesh& mesh, int label, const std::string& where, const std::string& body) {
  const std::vector<int> labels = boundaryLabels(mesh);
  if (std::binary_search(labels.begin(), labels.end(), label)) {
    return;
  }
  Keys words;
  for (const int known : labels) {
    words.push_back(std::to_string(known));
  }
  throw InputError(where + ": body " + body + ": label = " + std::to_string(label) +
                   (words.empty()
                        ? ", the mesh " + mesh.name + " has no labelled boundary"
                        : ", expected one of " + joined(words) + " (boundary labels of " + mesh.name + ")"));
}

/// The number of a label that is given as a name.
void findNumber(const std::map<std::string, int>& names, const std::string& name, const std::string& what,
                const TriangleMesh& mesh, const std::string& where, int& label) {
  if (name.empty()) {
    return;
  }
  const auto found = names.find(name);
  if (found == names.end()) {
    Keys words;
    for (const auto& [known, number] : names) {
      words.push_back(known);
    }
    throw InputError(where + ": label = \"" + name + "\", " +
                     (words.empty()
                          ? "the mesh " + mesh.name + " has no names of " + what
                          : "expected one of " + joined(words) + " (" + what + " of " + mesh.name + ")"));
  }
  label = found->second;
}

/// The vertices of a labelled boundary, or the middles of its edges.
std::vector<int> verticesOn(const TriangleMesh& mesh, int label) {
  std::vector<int> vertices;
  for (size_t e = 0; e < mesh.boundaryEdges.size(); ++e) {
    if (mesh.boundaryLabels[e] == label) {
      vertices.insert(vertices.end(), mesh.boundaryEdges[e].begin(), mesh.boundaryEdges[e].end());
    }
  }
  std::sort(vertices.begin(), vertices.end());
  vertices.erase(std::unique(vertices.begin(), vertices.end()), vertices.end());
  return vertices;
}

std::vector<Point> middlesOn(const TriangleMesh& mesh, int label) {
  std::vector<Point> points;
  for (size_t e = 0; e < mesh.boundaryEdges.size(); ++e) {
    if (mesh.boundaryLabels[e] == label) {
      const auto [a, b] = mesh.boundaryEdges[e];
      points.emplace_back(0.5 * (mesh.vertices[a] + mesh.vertices[b]));
    }
  }
  return points;
}

/// A few hundred centres of triangles are enough to find an expression that has no value.
std::vector<Point> centres(const TriangleMesh& mesh) {
  std::vector<Point> points;
  const size_t stride = 1 + mesh.triangles.size() / 500;
  for (size_t t = 0; t < mesh.triangles.size(); t += stride) {
    const auto [a, b, c] = mesh.triangles[t];
    points.emplace_back((mesh.vertices[a] + mesh.vertices[b] + mesh.vertices[c]) / 3);
  }
  return points;
}

void requireFiniteData(const BodyDescription& body, const TriangleMesh& mesh,
                       const std::vector<double>& times) {
  for (const ConditionDescription& condition : body.conditions) {
    if (condition.value.constant) {
      continue;
    }
    std::vector<Point> points;
    if (condition.kind == Kind::displacement) {
      for (const int v : verticesOn(mesh, condition.label)) {
        points.push_back(mesh.vertices[v]);
      }
    } else {
      points = middlesOn(mesh, condition.label);
      for (const int v : verticesOn(mesh, condition.label)) points.push_back(mesh.vertices[v]);
    }
    requireFinite(condition.value, points, times);
  }
  for (const std::optional<Expression>& force : body.force) {
    if (force && !force->constant) {
      requireFinite(*force, centres(mesh), times);
    }
  }
  const auto requireFiniteStress = [&](const StressDescription& stress) {
    for (const std::optional<Expression>& component : stress) {
      if (component && !component->constant) {
        requireFinite(*component, centres(mesh), {0});
      }
    }
  };
  requireFiniteStress(body.initialStress);
  for (const RegionDescription& region : body.regions) {
    requireFiniteStress(region.initialStress);
  }
}

/// Where labels meet, all may prescribe a motion of a node, but not differently.
void requireOneDisplacement(const Supports& supports,
                            const std::vector<const ConditionDescription*>& displacements,
                            const TriangleMesh& mesh, const std::vector<double>& times) {
  constexpr double rounding = 1e-9;  // normals of meshed circles are rounded
  for (const FurtherMotion& motion : supports.further()) {
    const NodeSupport& support = supports.nodes()[motion.support];
    const Point& p = mesh.vertices[support.node];
    for (const double t : times) {
      const auto valueOf = [&](int condition) {
        return displacements[condition]->value.value(p[0], p[1], t);
      };
      std::array<double, 2> values{0, 0};
      double scale = std::abs(valueOf(motion.condition));
      for (int i = 0; i < support.count; ++i) {
        values[i] = valueOf(support.conditions[i]);
        scale = std::max(scale, std::abs(values[i]));
      }
      const double implied = impliedMotion(support, values, motion.direction) + 0.0;  // no -0
      if (std::abs(valueOf(motion.condition) - implied) <= rounding * scale) {
        continue;
      }
      const auto labelOf = [&](int i) { return std::to_string(displacements[support.conditions[i]]->label); };
      const int same = sameMotion(support, motion.direction);
      throw InputError(displacements[motion.condition]->value.where + " at (" + shortest(p[0]) + ", " +
                       shortest(p[1]) + "), t = " + shortest(t) + ": expected the " + shortest(implied) +
                       " that " +
                       (same >= 0 ? "label " + labelOf(same) + " prescribes"
                                  : "labels " + labelOf(0) + " and " + labelOf(1) + " prescribe") +
                       " there");
    }
  }
}

std::shared_ptr<const Material> buildMaterial(const MaterialDescription& description) {
  const auto& [elasticity, viscoplasticity] = description;
  return viscoplasticity ? perzynaMaterial(elasticity, *viscoplasticity) : elasticMaterial(elasticity);
}

/// One material, or as many as regions ask for.
std::shared_ptr<const Material> buildMaterial(const BodyDescription& body, const TriangleMesh& mesh) {
  std::vector<std::shared_ptr<const Material>> materials{buildMaterial(body.material)};
  std::map<int, int> number;
  for (const RegionDescription& region : body.regions) {
    if (region.material) {
      number[region.label] = static_cast<int>(materials.size());
      materials.push_back(buildMaterial(*region.material));
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

void requireRegion(const TriangleMesh& mesh, const RegionDescription& region, const std::string& body) {
  const std::set<int> labels(mesh.regions.begin(), mesh.regions.end());
  if (labels.count(region.label) > 0) {
    return;
  }
  Keys words;
  for (const int known : labels) {
    words.push_back(std::to_string(known));
  }
  throw InputError(region.where + ": body " + body + ": region label = " + std::to_string(region.label) +
                   ", expected one of " + joined(words) + " (regions of " + mesh.name + ")");
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

Body buildBody(BodyDescription body, const std::vector<double>& times, std::vector<std::string>& warnings) {
  TriangleMesh mesh = readMesh(body.mesh);
  warnOfThinTriangles(body, mesh, warnings);
  for (ConditionDescription& c : body.conditions) {
    findNumber(mesh.labelNames, c.labelName, "boundaries", mesh, c.where + ": body " + body.name, c.label);
  }
  for (RegionDescription& region : body.regions) {
    findNumber(mesh.regionNames, region.labelName, "regions", mesh, region.where + ": body " + body.name,
               region.label);
  }
  Conditions conditions;
  std::vector<const ConditionDescription*> displacements;
  for (const ConditionDescription& c : body.conditions) {
    requireLabel(mesh, c.label, c.where, body.name);
    if (c.kind == Kind::displacement) {
      conditions.displacements.push_back({c.label, c.component, c.value.value});
      displacements.push_back(&c);
    } else {
      conditions.tractions.push_back({c.label, c.component, c.value.value});
    }
  }
  for (const RegionDescription& region : body.regions) {
    requireRegion(mesh, region, body.name);
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
  const std::shared_ptr<const Material> material = buildMaterial(body, mesh);
  return {body.name, std::move(mesh), material, std::move(conditions)};
}

/// Contact takes over the normal direction of its labels: further conditions there are rarely meant.
void warnOfConditionsOn(const SideDescription& side, bool nonmortar, const SceneDescription& scene,
                        std::vector<std::string>& warnings) {
  for (const ConditionDescription& c : scene.bodies[bodyIndex(scene, side.body)].conditions) {
    if (c.label == side.label && c.labelName == side.labelName && (c.kind == Kind::traction || nonmortar)) {
      warnings.push_back(c.value.where + ": label " + std::to_string(c.label) + " of body " + side.body +
                         " is in contact too; the condition is kept");
    }
  }
}

/// Whether the mortar side has the finer mesh along the contact and should be nonmortar. Measured by
/// bench_nonmortar_side; stiffness does not matter.
bool mortarIsFiner(const Model& model, const ContactPair& pair) {
  const auto meanLength = [&](const ContactSide& side) {
    const TriangleMesh& mesh = model.bodies[side.body].mesh();
    double length = 0;
    int edges = 0;
    for (size_t e = 0; e < mesh.boundaryEdges.size(); ++e) {
      if (mesh.boundaryLabels[e] == side.label) {
        const auto [a, b] = mesh.boundaryEdges[e];
        length += (mesh.vertices[b] - mesh.vertices[a]).norm();
        ++edges;
      }
    }
    return length / edges;
  };
  constexpr double equal = 1e-9;  // then the side named first
  return meanLength(pair.mortar) < (1 - equal) * meanLength(pair.nonmortar);
}

void addContact(const SceneDescription& scene, const ContactDescription& contact, Model& model,
                std::vector<std::string>& warnings) {
  ContactPair pair;
  pair.coupling = contact.variant;
  for (const auto& [side, target] :
       {std::pair(&contact.nonmortar, &pair.nonmortar), std::pair(&contact.mortar, &pair.mortar)}) {
    *target = {bodyIndex(scene, side->body), side->label};
    const TriangleMesh& mesh = model.bodies[target->body].mesh();
    findNumber(mesh.labelNames, side->labelName, "boundaries", mesh, side->where + ": body " + side->body,
               target->label);
    requireLabel(mesh, target->label, side->where, side->body);
  }
  const bool exchanged = !contact.sidesGiven && mortarIsFiner(model, pair);
  if (exchanged) {
    std::swap(pair.nonmortar, pair.mortar);
  }
  warnOfConditionsOn(contact.nonmortar, !exchanged, scene, warnings);
  warnOfConditionsOn(contact.mortar, exchanged, scene, warnings);
  InterfaceOptions options;
  options.initial = contact.initial;
  if (contact.gap) {
    std::vector<Point> points;
    for (const int v : verticesOn(model.bodies[pair.nonmortar.body].mesh(), pair.nonmortar.label)) {
      points.push_back(model.bodies[pair.nonmortar.body].mesh().vertices[v]);
    }
    requireFinite(*contact.gap, points, {0});
    options.gap = [value = contact.gap->value](const Point& x) { return value(x.x(), x.y(), 0); };
  }
  try {
    addInterface(model, pair, options);
  } catch (const InputError& error) {
    throw InputError(contact.where + ": contact: " + error.what());
  }
}

}  // namespace

Model buildModel(const SceneDescription& scene, std::vector<std::string>& warnings) {
  Model model;
  const std::vector<double> times = sampleTimes(scene.time);
  model.bodies.reserve(scene.bodies.size());
  for (const BodyDescription& body : scene.bodies) {
    model.bodies.push_back(buildBody(body, times, warnings));
  }
  for (const ContactDescription& contact : scene.contacts) {
    addContact(scene, contact, model, warnings);
  }
  return model;
}

}  // namespace mortier
