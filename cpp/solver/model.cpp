#include "solver/model.h"

#include <algorithm>
#include <cmath>
#include <optional>

#include "base/error.h"
#include "linear/distributed_engine.h"

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
  return std::ranges::any_of(model.interfaces, &ContactInterface::hasFriction);
}

bool anyFollows(const Model& model) {
  return std::ranges::any_of(model.interfaces, &ContactInterface::follows);
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
  return std::ranges::any_of(model.interfaces, &ContactInterface::distanceMoves);
}

LinearEngine engineOf(const Model& model, const Body& body, const SolverOptions& options) {
  constexpr int worthCorrecting = 20000;  // equations
  if (options.linear == LinearEngine::suitesparse) return options.linear;
  const bool possible = body.dimension() == 3 && body.material().symmetricTangent() &&
                        DistributedEngine::ofProgram() == nullptr;
  const bool pays =
      body.freeDofs() >= worthCorrecting && std::ranges::all_of(model.bodies, [](const Body& each) {
        return each.material().symmetricTangent() && each.material().usesReturnMapping();
      });
  return possible && (pays || options.linear == LinearEngine::single) ? LinearEngine::single
                                                                      : LinearEngine::multifrontal;
}

std::unique_ptr<CondensingSolver> newSolver(LinearEngine engine, const SparsePattern& pattern,
                                            const std::vector<int>& kept, Threads& threads) {
  DistributedEngine* distributed = DistributedEngine::ofProgram();
  auto solver = engine == LinearEngine::suitesparse ? suiteSparseSolver(pattern, kept)
                : distributed != nullptr            ? distributed->solver(pattern, kept)
                : engine == LinearEngine::single    ? singleSolver(pattern, kept)
                                                    : multifrontalSolver(pattern, kept);
  solver->use(threads);
  return solver;
}

bool solvesSparse(const Model& model, const SolverOptions& options) {
  double conditions = 0;
  double equations = 0;
  for (const ContactInterface& interface : model.interfaces) conditions += interface.rows();
  for (const Body& body : model.bodies) equations += body.freeDofs();
  const bool dense = anyFriction(model) || std::ranges::any_of(model.bodies, [](const Body& body) {
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

}  // namespace mortier
