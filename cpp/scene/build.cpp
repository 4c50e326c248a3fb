#include "scene/build.h"

#include <algorithm>
#include <utility>

#include "base/digits.h"
#include "base/error.h"
#include "base/interrupt.h"
#include "mesh/boundary_line.h"
#include "scene/document.h"
#include "scene/expression.h"
#include "scene/memory_need.h"
#include "scene/resolve.h"
#include "time/initial_balance.h"
#include "time/mean_pressure.h"
#include "time/nodal_forces.h"

namespace mortier {
namespace {

/// Where data are tried before the run: the ends of the first and last step, and between.
std::vector<double> sampleTimes(const TimePlan& plan) {
  const double step = plan.duration() / (plan.steps > 0 ? plan.steps : 100);
  return {plan.begin, plan.begin + step, plan.begin + 0.5 * plan.duration(), plan.end - step, plan.end};
}

/// Adds an interface or a tie. \throws InputError headed by the place of the contact.
template <class Add>
void addAt(const ContactDescription& contact, const Add& add) {
  const std::string where = contact.where + ": contact: ";
  try {
    add();
  } catch (const InputError& error) {
    throw InputError(where + error.what(), error.fault());
  }
}

ContactPair pairOf(const SceneDescription& scene, const ContactDescription& contact) {
  const auto side = [&](const SideDescription& of) {
    return ContactSide{bodyIndex(scene, of.body), of.label};
  };
  const ContactPair pair{side(contact.nonmortar()), side(contact.mortar()), contact.variant};
  if (pair.nonmortar.body == pair.mortar.body && pair.nonmortar.label == pair.mortar.label)
    throw InputError("both sides are label " + std::to_string(pair.mortar.label) + " of body " +
                         contact.mortar().body + ", expected two sides",
                     "same-side");
  return pair;
}

/// Where a support and the motion of a tool both prescribe what a node does. \throws InputError
void requireOneMotion(const Model& model, const Tie& tie, const std::vector<double>& times) {
  constexpr double rounding = 1e-9;
  if (tie.heldNodes().empty()) return;
  for (const double t : times) {
    std::vector<Vector> u;
    double largest = 0;
    for (const Body& body : model.bodies) {
      u.emplace_back(Vector::Zero(body.dofs()));
      body.prescribe(t, u.back());
      largest = std::max(largest, u.back().lpNorm<Eigen::Infinity>());
    }
    Eigen::Index row = 0;
    const double off = tie.heldJump(u).cwiseAbs().maxCoeff(&row);
    if (off <= rounding * largest) continue;
    const Body& body = model.bodies[tie.pair().nonmortar.body];
    const SpacePoint x = body.placeOfNode(tie.heldNodes()[static_cast<size_t>(row)]);
    throw InputError("the supports of body " + body.name() + " and the motion of tool " +
                     model.bodies[tie.pair().mortar.body].name() + " differ by " + digits(off, 3) + " at (" +
                     digits(x.x()) + ", " + digits(x.y()) +
                     (body.dimension() == 3 ? ", " + digits(x.z()) : "") + "), t = " + digits(t) +
                     ", expected one of them or the same displacement");
  }
}

}  // namespace

Model buildModel(ResolvedScene& scene) {
  Model model;
  const SceneDescription& description = scene.description;
  const std::vector<double> times = sampleTimes(description.time);
  model.bodies.reserve(description.bodies.size());
  for (size_t b = 0; b < description.bodies.size(); ++b) {
    stopIfInterrupted();
    const BodyDescription& body = description.bodies[b];
    model.bodies.push_back(description.inSpace()
                               ? buildBody(body, std::move(scene.spaceMeshes[b]), description, times)
                               : buildBody(body, std::move(scene.meshes[b]), description, times));
  }
  scene.meshes.clear();
  scene.spaceMeshes.clear();
  if (description.inSpace()) requireMemory(memoryNeed(model, description.solver), false);
  for (const ContactDescription& contact : description.contacts) {
    stopIfInterrupted();
    addContact(description, contact, model);
  }
  for (const ContactDescription& tie : description.ties) {
    stopIfInterrupted();
    addAt(tie, [&] {
      TieOptions options;
      options.kind = tie.tieKind;
      options.along = tie.along;
      options.stiffness = tie.stiffness;
      options.offsetOfMortar = tie.nonmortarSide == 1;
      addTie(model, pairOf(description, tie), options,
             tie.offset.empty() ? -1 : bodyIndex(description, tie.offset));
      if (!description.goesOn()) requireOneMotion(model, model.ties.back(), times);
      requireMemory(memoryNeed(model, description.solver), false);
    });
  }
  if (solvesSparse(model, description.solver))  // of such long lines with C alone
    for (ContactInterface& interface : model.interfaces) interface.stopYielding();
  return model;
}

std::string findInitialEquilibrium(const SceneDescription& scene, const Model& model, State state) {
  constexpr double noticeable = 1e-6;
  const auto stressed = [](const Body& body) { return body.hasInitialStress(); };
  if (std::none_of(model.bodies.begin(), model.bodies.end(), stressed)) return "";
  double change = 0;
  try {
    change = balanceInitialStress(model, state, scene.solver);
  } catch (const InputError& error) {
    throw InputError(scene.path + ": " + error.what());
  }
  if (change <= noticeable) return "";
  return "the initial stress is not in equilibrium with the loads at t = 0; the bodies settled elastically, "
         "which "
         "changed it by up to " +
         digits(change) + " of the largest stress";
}

namespace {

/// Whether a label is a side of a contact, of one with friction if that is asked for.
bool isInContact(const Model& model, int body, int label, bool rough) {
  return std::any_of(model.interfaces.begin(), model.interfaces.end(),
                     [&](const ContactInterface& interface) {
                       return isSide(interface.pair(), body, label) && (interface.hasFriction() || !rough);
                     });
}

bool isTied(const Model& model, int body, int label) {
  return std::ranges::any_of(model.ties, [&](const Tie& tie) { return isSide(tie.pair(), body, label); });
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
    quantity.point = description.pointInSpace;
    if (description.point) quantity.point = asSpacePoint(*description.point);
    const std::string point = description.point          ? shortest(*description.point)
                              : description.pointInSpace ? shortest(*description.pointInSpace)
                                                         : "";
    const bool atPoint = quantity.kind == Quantity::Kind::reaction && !point.empty();
    const std::string label =
        (atPoint ? "point " + point : "label " + std::to_string(quantity.label)) + " of body " + body.name();
    if (quantity.kind == Quantity::Kind::reaction && firstSupport(body, quantity.label, quantity.point) < 0)
      refuse(label + " has no prescribed displacement, expected one that has: supports alone react");
    using Kind = Quantity::Kind;
    const bool isOfContact = quantity.kind == Kind::contactForce || quantity.kind == Kind::largestPressure ||
                             quantity.kind == Kind::contactLength || quantity.kind == Kind::contactArea ||
                             quantity.kind == Kind::meanPressure;
    const bool ofTie =
        quantity.kind == Quantity::Kind::contactForce && isTied(model, quantity.body, quantity.label);
    if (isOfContact && !ofTie && !isInContact(model, quantity.body, quantity.label, false))
      refuse(label + " is no side of a contact, expected one");
    if (quantity.kind == Quantity::Kind::frictionWork &&
        !isInContact(model, quantity.body, quantity.label, true))
      refuse(label + " is no side of a contact with friction, expected one");
    if (quantity.kind == Quantity::Kind::displacement) {
      if (const SpaceElements* space = body.space())
        quantity.mean = quantity.point ? meanAt(space->mesh(), space->nodes(), *quantity.point)
                                       : meanOn(space->mesh(), space->nodes(), quantity.label);
      else
        quantity.mean = quantity.point
                            ? meanAt(body.mesh(), body.elementNodes(), quantity.point->head<2>())
                            : meanOn(body.mesh(), body.elementNodes(), quantity.label, body.axisymmetric());
      if (quantity.mean.empty()) refuse("point = " + point + ", expected a point of body " + body.name());
    }
    if (quantity.kind == Kind::meanPressure && body.space() != nullptr) {
      quantity.shares = meanPressureShares(model, quantity.body, quantity.label);
    } else if (quantity.kind == Kind::meanPressure) {
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

std::string doubtOfPolygons(const ContactInterface& interface, const std::string& length) {
  constexpr double noticeable = 0.02;  // of the pressure, where that is in proportion to the distance
  const double distance = interface.initialDistance().cwiseAbs().mean();
  if (!(interface.sagitta() > noticeable * distance)) return "";
  return "no circle fits the nodes to 1e-6, so the distance is that of the polygons, " + digits(distance) +
         " " + length + " in the mean; they are off the curves behind them by up to " +
         digits(interface.sagitta()) + " " + length + ", and pressures are wrong in that ratio";
}

void addContact(const SceneDescription& scene, const ContactDescription& contact, Model& model) {
  const ContactPair pair = pairOf(scene, contact);
  const Body& nonmortar = model.bodies[pair.nonmortar.body];
  const bool inSpace = scene.inSpace();
  std::vector<const TriangleMesh*> meshes;
  for (const Body& body : model.bodies) meshes.push_back(&body.mesh());
  InterfaceOptions options;
  options.initial = contact.initial;
  options.friction = contact.friction;
  options.stabilised = contact.stabilised;
  options.follows = contact.sliding == SlidingKind::finite;
  options.axisymmetric = scene.plane == Plane::axisymmetric;
  if (!inSpace) options.stiffness = stiffnessRatio(scene, contact.nonmortar(), contact.mortar(), meshes);
  options.mortarCompliance =
      inSpace ? surfaceCompliance(scene, contact.mortar(), model.bodies[pair.mortar.body].space()->mesh())
              : surfaceCompliance(scene, contact.mortar(), meshes);
  if (contact.gap) {
    nonmortar.withMesh([&](const auto&, const auto& nodes) {
      std::remove_cvref_t<decltype(nodes.places)> places;
      for (const int node : nonmortar.boundaryNodes(pair.nonmortar.label))
        places.push_back(nodes.places[node]);
      requireFinite(*contact.gap, places,
                    {scene.time.begin, contact.gap->inTime ? scene.time.end : scene.time.begin});
    });
    options.gap = finiteValue(*contact.gap, inSpace);
  }
  std::vector<ContactPair> pairs{pair};
  std::vector<bool> rough{contact.friction.any()};
  for (const ContactInterface& interface : model.interfaces) {
    pairs.push_back(interface.pair());
    rough.push_back(interface.hasFriction());
  }
  addAt(contact, [&] {
    if (!inSpace) requireMemory(meshes, pairs, scene.degree, rough, scene.solver);
    addInterface(model, pair, options);
    if (inSpace) requireMemory(memoryNeed(model, scene.solver), contact.friction.any());
  });
}

}  // namespace mortier
