#include "solver/model.h"

#include <algorithm>
#include <cmath>
#include <optional>
#include <set>

#include "base/error.h"
#include "linear/distributed_engine.h"

namespace mortier {

bool holds(const Body& body, int node, const SpacePoint& direction) {
  constexpr double rounding = 1e-9;
  if (const Eigen::Index n = body.dimension(); body.rigid())
    return (body.freeMotions().middleRows(n * node, n).transpose() * direction.head(n)).isZero(rounding);
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
  const bool dense =
      anyFriction(model) || !model.ties.empty() || std::ranges::any_of(model.bodies, [](const Body& body) {
        return body.rigid() && body.freeDofs() > 0;  // no stiffness stands for them
      });
  return !anyFollows(model) && solvesSparse(conditions, equations, dense, options);
}

bool solvesSparse(double conditions, double equations, bool rough, const SolverOptions& options) {
  return !rough && options.method == Method::newton &&
         conditions * conditions * conditions > options.denseWork * equations;
}

namespace {

struct BodiesOfPair {
  const Body& nonmortar;
  const Body& mortar;
};

BodiesOfPair bodiesOf(const Model& model, const ContactPair& pair) {
  const BodiesOfPair both{model.bodies[pair.nonmortar.body], model.bodies[pair.mortar.body]};
  if (both.nonmortar.dimension() != both.mortar.dimension())
    throw InputError("bodies " + both.nonmortar.name() + " and " + both.mortar.name() +
                     ": contact between the plane and space, expected two bodies of one of them");
  return both;
}

/// Calls work with the mesh and the nodes of both.
template <class Work>
void withMeshes(const BodiesOfPair& of, const Work& work) {
  const auto& [nonmortar, mortar] = of;
  if (const SpaceElements* space = nonmortar.space())
    work(SpaceContactMesh{space->mesh(), space->nodes()},
         SpaceContactMesh{mortar.space()->mesh(), mortar.space()->nodes()});
  else
    work(ContactMesh{nonmortar.mesh(), nonmortar.elementNodes()},
         ContactMesh{mortar.mesh(), mortar.elementNodes()});
}

bool isZero(const Datum& value, const SpacePoint& at) {
  return value && value.constant() && value(at, 0) == 0;
}

/// Of a rigid body in space: the axes along which none of its motions moves a node.
std::vector<SpacePoint> fixedAxes(const Body& body, int node) {
  constexpr int n = 3;
  const RigidMotion& rigid = *body.conditions().rigid;
  const SpacePoint arm = body.placeOfNode(node) - rigid.at;
  SpacePoint moves = SpacePoint::Zero();
  for (int c = 0; c < n; ++c) {
    if (!isZero(rigid.held[c], rigid.at)) moves += SpacePoint::Unit(c);
    if (!isZero(rigid.held[n + c], rigid.at)) moves += SpacePoint::Unit(c).cross(arm).cwiseAbs();
  }
  std::vector<SpacePoint> fixed;
  for (int c = 0; c < n; ++c)
    if (moves[c] == 0) fixed.push_back(SpacePoint::Unit(c));
  return fixed;
}

}  // namespace

/// Directions in which the displacement of a node is zero at all times.
std::vector<SpacePoint> fixedDirections(const Body& body, int node) {
  if (body.rigid()) return fixedAxes(body, node);
  const std::vector<NodeSupport>& supports = body.supports().nodes();
  const auto found = std::ranges::lower_bound(supports, node, {}, &NodeSupport::node);
  std::vector<SpacePoint> fixed;
  if (found == supports.end() || found->node != node) return fixed;
  for (int i = 0; i < found->count; ++i) {
    const Datum& value = body.conditions().displacements[found->conditions[i]].value;
    if (isZero(value, found->place)) fixed.push_back(found->directions[i]);
  }
  return fixed;
}

void addInterface(Model& model, const ContactPair& pair, InterfaceOptions options) {
  const BodiesOfPair both = bodiesOf(model, pair);
  options.nonmortarHeld = [&](int node, const SpacePoint& n) { return holds(both.nonmortar, node, n); };
  options.mortarHeld = [&](int node, const SpacePoint& n) { return holds(both.mortar, node, n); };
  options.nonmortarFixed = [&](int node) { return fixedDirections(both.nonmortar, node); };
  options.mortarFixed = [&](int node) { return fixedDirections(both.mortar, node); };
  withMeshes(both, [&](const auto& nonmortar, const auto& mortar) {
    model.interfaces.emplace_back(pair, nonmortar, mortar, options);
  });
}

void addTie(Model& model, const ContactPair& pair, TieOptions options, int offset) {
  const BodiesOfPair both = bodiesOf(model, pair);
  std::set<int> taken;
  for (const Tie& other : model.ties)
    if (other.pair().nonmortar.body == pair.nonmortar.body)
      taken.insert(other.nonmortarNodes().begin(), other.nonmortarNodes().end());
  options.nonmortarHeld = [&](int node, const SpacePoint& d) { return holds(both.nonmortar, node, d); };
  options.mortarHeld = [&](int node, const SpacePoint& d) { return holds(both.mortar, node, d); };
  options.taken = [&](int node) { return taken.contains(node); };
  options.frame = [&](int node) {
    const Eigen::Matrix3d* turned = both.nonmortar.supports().frameOf(node);
    return turned == nullptr ? Eigen::Matrix3d(Eigen::Matrix3d::Identity()) : *turned;
  };
  options.axisymmetric = both.nonmortar.axisymmetric();
  if (offset >= 0) {
    const Body& third = model.bodies[offset];
    options.offsetHeld = [&](int node, const SpacePoint& d) { return holds(third, node, d); };
    withMeshes({third, third}, [&](const auto& mesh, const auto&) { options.offset.emplace(offset, mesh); });
  }
  withMeshes(both, [&](const auto& nonmortar, const auto& mortar) {
    model.ties.emplace_back(pair, nonmortar, mortar, options);
  });
}

}  // namespace mortier
