#include "scene/build.h"

#include <algorithm>

#include "base/error.h"
#include "mesh/boundary_line.h"
#include "scene/document.h"
#include "time/mean_pressure.h"
#include "time/nodal_forces.h"

namespace mortier {
namespace {

/// Whether a label is a side of a contact, of one with friction if that is asked for.
bool isInContact(const Model& model, int body, int label, bool rough) {
  return std::any_of(model.interfaces.begin(), model.interfaces.end(),
                     [&](const ContactInterface& interface) {
                       return isSide(interface, body, label) && (interface.hasFriction() || !rough);
                     });
}

}  // namespace

std::vector<Quantity> buildQuantities(const SceneDescription& scene, const Model& model) {
  std::vector<Quantity> quantities;
  for (const QuantityDescription& description : scene.quantities) {
    Quantity quantity{description.name,  description.kind,      bodyIndex(scene, description.body),
                      description.label, description.component, description.about};
    const Body& body = model.bodies[quantity.body];
    if (description.whole) {
      quantity.whole = true;
      quantities.push_back(std::move(quantity));
      continue;
    }
    const auto refuse = [&](const std::string& what) {
      throw InputError(description.where + ": quantity " + quantity.name + ": " + what);
    };
    if (quantity.kind == Quantity::Kind::reaction) {
      quantity.point = description.point;
      quantity.pointInSpace = description.pointInSpace;
    }
    const std::string point = description.point          ? shortest(*description.point)
                              : description.pointInSpace ? shortest(*description.pointInSpace)
                                                         : "";
    const bool atPoint = quantity.kind == Quantity::Kind::reaction && !point.empty();
    const std::string label =
        (atPoint ? "point " + point : "label " + std::to_string(quantity.label)) + " of body " + body.name();
    if (quantity.kind == Quantity::Kind::reaction &&
        firstSupport(body, quantity.label, quantity.point, quantity.pointInSpace) < 0)
      refuse(label + " has no prescribed displacement, expected one that has: supports alone react");
    const bool isOfContact =
        quantity.kind == Quantity::Kind::contactForce || quantity.kind == Quantity::Kind::largestPressure ||
        quantity.kind == Quantity::Kind::contactLength || quantity.kind == Quantity::Kind::meanPressure;
    if (isOfContact && !isInContact(model, quantity.body, quantity.label, false))
      refuse(label + " is no side of a contact, expected one");
    if (quantity.kind == Quantity::Kind::frictionWork &&
        !isInContact(model, quantity.body, quantity.label, true))
      refuse(label + " is no side of a contact with friction, expected one");
    if (quantity.kind == Quantity::Kind::displacement) {
      if (const SpaceElements* space = body.space())
        quantity.mean = description.pointInSpace ? meanAt(*space, *description.pointInSpace)
                                                 : meanOn(*space, quantity.label);
      else
        quantity.mean = description.point
                            ? meanAt(body.mesh(), body.elementNodes(), *description.point)
                            : meanOn(body.mesh(), body.elementNodes(), quantity.label, body.axisymmetric());
      if (quantity.mean.empty()) refuse("point = " + point + ", expected a point of body " + body.name());
    }
    if (quantity.kind == Quantity::Kind::meanPressure) {
      const BoundaryLine line = boundaryLine(body.mesh(), quantity.label);
      try {
        quantity.part = description.part ? LinePart(line, description.part->from, description.part->to,
                                                    description.part->margin)
                                         : LinePart(line);
      } catch (const InputError& error) {
        refuse(label + ": " + error.what());
      }
      quantity.shares = meanPressureShares(model, quantity.body, quantity.label, *quantity.part);
    }
    quantities.push_back(std::move(quantity));
  }
  return quantities;
}

}  // namespace mortier
