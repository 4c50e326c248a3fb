#include "scene/build_contact.h"

#include <iomanip>
#include <sstream>
#include <utility>

#include "base/error.h"
#include "mesh/boundary_line.h"
#include "scene/memory_need.h"

namespace mortier {

namespace {

/// Contact takes over the normal direction of its labels: further conditions there are rarely meant.
void warnOfConditionsOn(const SideDescription& side, bool nonmortar, const SceneDescription& scene,
                        std::vector<std::string>& warnings) {
  for (const ConditionDescription& c : scene.bodies[bodyIndex(scene, side.body)].conditions) {
    if (c.label == side.label && (c.kind == ConditionDescription::Kind::traction || nonmortar)) {
      warnings.push_back(c.value.where + ": label " + std::to_string(c.label) + " of body " + side.body +
                         " is in contact too; the condition is kept");
    }
  }
}

std::string twoDigits(double x) {
  std::ostringstream text;
  text << std::setprecision(2) << x;
  return text.str();
}

}  // namespace

std::string doubtOfPolygons(const ContactInterface& interface) {
  constexpr double noticeable = 0.02;  // of the pressure, where that is in proportion to the distance
  const double distance = interface.initialDistance().cwiseAbs().mean();
  if (!(interface.sagitta() > noticeable * distance)) return "";
  return "no circle fits the nodes to 1e-6, so the distance is that of the polygons, " + twoDigits(distance) +
         " m in the mean; they are off the curves behind them by up to " + twoDigits(interface.sagitta()) +
         " m, and pressures are wrong in that ratio";
}

void addContact(const SceneDescription& scene, const ContactDescription& contact, Model& model,
                std::vector<std::string>& warnings) {
  ContactPair pair;
  pair.coupling = contact.variant;
  for (const auto& [side, target] :
       {std::pair(&contact.nonmortar, &pair.nonmortar), std::pair(&contact.mortar, &pair.mortar)}) {
    target->body = bodyIndex(scene, side->body);
    target->label = side->label;
  }
  warnOfConditionsOn(contact.nonmortar, true, scene, warnings);
  warnOfConditionsOn(contact.mortar, false, scene, warnings);
  InterfaceOptions options;
  options.initial = contact.initial;
  if (contact.gap) {
    const TriangleMesh& mesh = model.bodies[pair.nonmortar.body].mesh();
    std::vector<Point> points;
    for (const int v : verticesOn(mesh, pair.nonmortar.label)) {
      points.push_back(mesh.vertices[v]);
    }
    requireFinite(*contact.gap, points, {0});
    options.gap = [value = contact.gap->value](const Point& x) { return value(x.x(), x.y(), 0); };
  }
  std::vector<const TriangleMesh*> meshes;
  for (const Body& body : model.bodies) meshes.push_back(&body.mesh());
  std::vector<ContactPair> pairs{pair};
  for (const ContactInterface& interface : model.interfaces) pairs.push_back(interface.pair());
  try {
    requireMemory(meshes, pairs);
    addInterface(model, pair, options);
    if (const std::string doubt = doubtOfPolygons(model.interfaces.back()); !doubt.empty())
      warnings.push_back(contact.where + ": contact: " + doubt);
  } catch (const InputError& error) {
    throw InputError(contact.where + ": contact: " + error.what());
  }
}

}  // namespace mortier
