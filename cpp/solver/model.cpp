#include "solver/model.h"

#include <algorithm>
#include <cmath>
#include <optional>

#include "base/error.h"

namespace mortier {

bool holds(const Body& body, int node, const SpacePoint& direction) {
  constexpr double rounding = 1e-9;
  if (body.rigid())
    return (body.freeMotions().middleRows<2>(2 * node).transpose() * direction.head<2>()).isZero(rounding);
  for (const auto& [equation, value] : body.parts(node, direction))
    if (equation >= 0 && std::abs(value) > rounding) return false;
  return true;
}

bool anyFriction(const Model& model) {
  return std::any_of(model.interfaces.begin(), model.interfaces.end(),
                     [](const ContactInterface& interface) { return interface.hasFriction(); });
}

bool anyFollows(const Model& model) {
  return std::any_of(model.interfaces.begin(), model.interfaces.end(),
                     [](const ContactInterface& interface) { return interface.follows(); });
}

void follow(const Model& model, const std::vector<Vector>& u, bool keepRows) {
  for (ContactInterface& interface : model.interfaces) {
    if (!interface.follows()) continue;
    const int b = interface.pair().mortar.body;
    const Body& mortar = model.bodies[b];
    std::optional<MortarMotion> motion;
    if (mortar.turns()) motion = {mortar.moved(u[b]), mortar.changeOfMoved(u[b], interface.mortarNodes())};
    interface.follow(u[interface.pair().nonmortar.body], u[b], keepRows, motion ? &*motion : nullptr);
  }
}

bool anyDistanceMoves(const Model& model) {
  return std::any_of(model.interfaces.begin(), model.interfaces.end(),
                     [](const ContactInterface& interface) { return interface.distanceMoves(); });
}

LinearEngine engineOf(const Model& model, const Body& body, const SolverOptions& options) {
  constexpr int worthCorrecting = 20000;  // equations
  if (options.linear == LinearEngine::suitesparse) return options.linear;
  const bool possible = body.dimension() == 3 && body.material().symmetricTangent() && !model.inParts();
  const bool pays = body.freeDofs() >= worthCorrecting &&
                    std::all_of(model.bodies.begin(), model.bodies.end(), [](const Body& each) {
                      return each.material().symmetricTangent() && each.material().usesReturnMapping();
                    });
  return possible && (pays || options.linear == LinearEngine::single) ? LinearEngine::single
                                                                      : LinearEngine::multifrontal;
}

bool solvesSparse(const Model& model, const SolverOptions& options) {
  double conditions = 0;
  double equations = 0;
  for (const ContactInterface& interface : model.interfaces) conditions += interface.rows();
  for (const Body& body : model.bodies) equations += body.freeDofs();
  const bool dense =
      anyFriction(model) || std::any_of(model.bodies.begin(), model.bodies.end(), [](const Body& body) {
        return body.rigid() && body.freeDofs() > 0;  // no stiffness stands for them
      });
  return !anyFollows(model) && solvesSparse(conditions, equations, dense, options);
}

bool solvesSparse(double conditions, double equations, bool rough, const SolverOptions& options) {
  return !rough && options.method == Method::newton &&
         conditions * conditions * conditions > options.denseWork * equations;
}

void addInterface(Model& model, const ContactPair& pair, InterfaceOptions options) {
  const Body& nonmortar = model.bodies[pair.nonmortar.body];
  const Body& mortar = model.bodies[pair.mortar.body];
  if (nonmortar.dimension() != mortar.dimension())
    throw InputError("bodies " + nonmortar.name() + " and " + mortar.name() +
                     ": contact between the plane and space, expected two bodies of one of them");
  if (nonmortar.space() != nullptr) {
    const auto meshOf = [](const Body& body) {
      return SpaceContactMesh{body.space()->mesh(), body.space()->nodes()};
    };
    model.interfaces.push_back(ContactInterface::inSpace(
        pair, meshOf(nonmortar), meshOf(mortar),
        {options.initial, [&](int node, const SpacePoint& n) { return holds(nonmortar, node, n); },
         [&](int node, const SpacePoint& n) { return holds(mortar, node, n); }, options.gapInSpace,
         options.gapMoves, options.mortarCompliance, options.stabilised}));
    return;
  }
  options.nonmortarHeld = [&](int node, const Point& n) { return holds(nonmortar, node, {n.x(), n.y(), 0}); };
  options.mortarHeld = [&](int node, const Point& n) { return holds(mortar, node, {n.x(), n.y(), 0}); };
  model.interfaces.emplace_back(pair, ContactMesh{nonmortar.mesh(), nonmortar.elementNodes()},
                                ContactMesh{mortar.mesh(), mortar.elementNodes()}, options);
}

Model inParts(const Model& whole, Ranks& ranks) {
  Model model;
  model.ranks = &ranks;
  const std::vector<std::vector<int>> owners = ownersOf(whole.bodies, ranks);
  std::vector<std::vector<int>> numbers;
  for (size_t b = 0; b < whole.bodies.size(); ++b) {
    model.parts.push_back(partOf(whole.bodies[b], owners[b], ranks));
    const BodyCut& cut = model.parts[b].cut;
    model.bodies.emplace_back(whole.bodies[b], cut);
    std::vector<int>& number = numbers.emplace_back(whole.bodies[b].nodes(), -1);
    for (size_t i = 0; i < cut.nodes.size(); ++i) number[cut.nodes[i]] = static_cast<int>(i);
  }
  for (const ContactInterface& interface : whole.interfaces) {
    const int one = interface.pair().nonmortar.body;
    const int two = interface.pair().mortar.body;
    model.interfaces.push_back(interface.renumbered({numbers[one], numbers[two]},
                                                    {model.bodies[one].nodes(), model.bodies[two].nodes()}));
  }
  return model;
}

}  // namespace mortier
