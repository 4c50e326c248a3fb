#include "scene/build.h"

#include <utility>

#include "base/digits.h"
#include "base/fault_error.h"
#include "mesh/boundary_line.h"
#include "scene/finite_value.h"
#include "scene/memory_need.h"
#include "scene/resolve.h"

namespace mortier {

std::string doubtOfPolygons(const ContactInterface& interface, const std::string& length) {
  constexpr double noticeable = 0.02;  // of the pressure, where that is in proportion to the distance
  const double distance = interface.initialDistance().cwiseAbs().mean();
  if (!(interface.sagitta() > noticeable * distance)) return "";
  return "no circle fits the nodes to 1e-6, so the distance is that of the polygons, " + digits(distance) +
         " " + length + " in the mean; they are off the curves behind them by up to " +
         digits(interface.sagitta()) + " " + length + ", and pressures are wrong in that ratio";
}

namespace {

/// Adds the interface. \throws InputError headed by the place of the contact.
template <class Add>
void addAt(const ContactDescription& contact, const Add& add) {
  const std::string where = contact.where + ": contact: ";
  try {
    add();
  } catch (const FaultError& error) {
    throw FaultError(where + error.what(), error.id());
  } catch (const InputError& error) {
    throw InputError(where + error.what());
  }
}

}  // namespace

void addContact(const SceneDescription& scene, const ContactDescription& contact, Model& model) {
  ContactPair pair;
  pair.coupling = contact.variant;
  for (const auto& [side, target] :
       {std::pair(&contact.nonmortar, &pair.nonmortar), std::pair(&contact.mortar, &pair.mortar)}) {
    target->body = bodyIndex(scene, side->body);
    target->label = side->label;
  }
  InterfaceOptions options;
  options.initial = contact.initial;
  if (scene.inSpace()) {
    if (contact.gap) {
      const Body& body = model.bodies[pair.nonmortar.body];
      std::vector<SpacePoint> places;
      for (const int node : body.boundaryNodes(pair.nonmortar.label))
        places.push_back(body.placeOfNode(node));
      requireFinite(*contact.gap, places, {0, contact.gap->inTime ? scene.time.end : 0});
      options.gapInSpace = finiteInSpace(*contact.gap);
      options.gapMoves = contact.gap->inTime;
    }
    return addAt(contact, [&] {
      addInterface(model, pair, options);
      requireMemory(memoryNeed(model, scene.solver), false);
    });
  }
  std::vector<const TriangleMesh*> meshes;
  for (const Body& body : model.bodies) meshes.push_back(&body.mesh());
  options.friction = contact.friction;
  options.follows = contact.sliding == SlidingKind::finite;
  options.axisymmetric = scene.plane == Plane::axisymmetric;
  options.stiffness = stiffnessRatio(scene, contact.nonmortar, contact.mortar, meshes);
  if (contact.gap) {
    const Body& body = model.bodies[pair.nonmortar.body];
    std::vector<Point> points;
    for (const BoundaryStretch& stretch : body.elementNodes().boundary)
      if (body.mesh().boundaryLabels[stretch.edge] == pair.nonmortar.label)
        for (const int node : stretch.nodes) points.push_back(body.elementNodes().places[node]);
    requireFinite(*contact.gap, points, {0, contact.gap->inTime ? scene.time.end : 0});
    options.gap = [value = contact.gap->value](const Point& x) { return value(x.x(), x.y(), 0); };
    if (contact.gap->inTime)
      options.gapInTime = [value = finiteValue(*contact.gap)](const Point& x, double t) {
        return value(x.x(), x.y(), t);
      };
  }
  std::vector<ContactPair> pairs{pair};
  std::vector<bool> rough{contact.friction.any()};
  for (const ContactInterface& interface : model.interfaces) {
    pairs.push_back(interface.pair());
    rough.push_back(interface.hasFriction());
  }
  addAt(contact, [&] {
    requireMemory(meshes, pairs, scene.degree, rough, scene.solver);
    addInterface(model, pair, options);
    if (contact.gap) model.interfaces.back().setGiven(finiteValue(*contact.gap));
  });
}

}  // namespace mortier
