#include "time/quantity_error.h"

#include <algorithm>
#include <cmath>
#include <optional>

#include "fem/data_misfit.h"
#include "time/curve_error.h"
#include "time/largest_error.h"
#include "time/march.h"
#include "time/nodal_forces.h"
#include "time/quantity_motion.h"

namespace mortier {
namespace {

using Kind = Quantity::Kind;

/// Estimates are as often below the error as above it. Twice of them holds it in 95 % of all cases, as the
/// factor of safety of Roache's index of grid convergence does.
constexpr double factorOfSafety = 2;
/// The part of a product of errors of an element by which it may be off: what cancels is not known to less,
/// unless equilibrium or symmetry decides it.
constexpr double uncertainPart = 0.2;
constexpr double cancelled = 1e-4;

/// The conditions of a linear quantity on z: motions that it has, on top of those of the response (dofs);
/// forces.
struct Goal {
  std::vector<Vector> motion, force;
  bool moves = false;          ///< whether there are motions
  bool betweenBodies = false;  ///< whether contact does not follow them
};

/// A motion of the nonmortar nodes along the normals by values of rows. Nodes without a row move as the rows
/// that they act on.
Vector motionOfRows(const ContactInterface& interface, const Body& body, const Vector& values) {
  const int dimension = body.dimension();
  Vector motion = Vector::Zero(body.dofs());
  Vector weights = Vector::Zero(body.nodes());
  std::vector<char> own(static_cast<size_t>(body.nodes()), 0);
  const auto move = [&](int node, int row, double weight) {
    motion.segment(Eigen::Index{dimension} * node, dimension) +=
        weight * values[row] * interface.normals()[row].head(dimension);
  };
  for (int row = 0; row < interface.rows(); ++row) {
    own[interface.nonmortarNodes()[row]] = 1;
    move(interface.nonmortarNodes()[row], row, 1);
  }
  for (int row = 0; row < interface.rows(); ++row)
    for (ConstraintRows::InnerIterator entry(interface.C1(), row); entry; ++entry)
      if (const int node = static_cast<int>(entry.col()) / dimension; own[node] == 0) {
        weights[node] += std::abs(entry.value());
        move(node, row, std::abs(entry.value()));
      }
  for (int node = 0; node < body.nodes(); ++node)
    if (weights[node] > 0) motion.segment(Eigen::Index{dimension} * node, dimension) /= weights[node];
  return motion;
}

/// The linear problem in which contact stays as it is.
class Adjoint {
 public:
  Adjoint(const Model& model, StepTaker& taker, double begin)
      : model_(model), state_(taker.state()), initial_(initialState(model)), on_(startingIterate(state_)) {
    on_.active = taker.active();
    for (size_t k = 0; k < on_.slipDirections.size(); ++k) {
      const ContactInterface& interface = model.interfaces[k];
      if (on_.slipDirections[k].empty()) continue;
      const Vector slip = interface.slip(state_.bodies[interface.pair().nonmortar.body].displacement,
                                         state_.bodies[interface.pair().mortar.body].displacement);
      for (Eigen::Index row = 0; row < interface.rows(); ++row)
        if (const double force = state_.frictionForce[k].segment<2>(2 * row).norm(); force > 0)
          on_.slipDirections[k][row].turning = slip.segment<2>(2 * row).norm() / force;
    }
    StepData data{state_.time, state_.time - begin, {}};
    initial_.time = begin;
    addThermalStrain(model, initial_, data);
    Iterate iterate = on_;
    for (size_t b = 0; b < model.bodies.size(); ++b)
      iterate.bodies[b].increment.high = state_.bodies[b].displacement;
    StepOutcome outcome;
    StepSystem& system = taker.system();
    linearised_.emplace(system.linearise(system.step(initial_, data), iterate, state_.time - begin, false));
    if (system.sparse() && system.contactHolds())
      obstacle_ = "contact alone holds bodies, along a long line";
    else if (factors_ = linearised_->factorise(outcome); !factors_)
      obstacle_ = outcome.detail;
  }
  [[nodiscard]] const std::string& obstacle() const { return obstacle_; }

  /// z and E eps(z), with displacements whose gap contact leaves open.
  [[nodiscard]] std::vector<Response> operator()(const Goal& goal) const {
    LinearLoad to;
    to.adjoint = true;
    to.force = goal.force;
    for (size_t b = 0; b < model_.bodies.size(); ++b) to.strain.push_back(-strainOf(b, goal.motion[b]));
    if (goal.moves && !goal.betweenBodies)
      for (const ContactInterface& interface : model_.interfaces) {
        const Vector& u1 = goal.motion[interface.pair().nonmortar.body];
        const Vector& u2 = goal.motion[interface.pair().mortar.body];
        to.across.emplace_back(-interface.jump(u1, u2));
        to.slip.emplace_back(interface.hasFriction() ? Vector(-interface.slip(u1, u2)) : Vector());
      }
    std::vector<Response> z = factors_->respond(to, on_);
    for (size_t b = 0; b < z.size(); ++b) {
      const Vector all = z[b].displacement + goal.motion[b];
      z[b].stress = elasticStress(b, strainOf(b, all));
      if (!goal.betweenBodies) z[b].displacement = all;
    }
    closeSlipping(z);
    return z;
  }

  /// What rounding makes of a quantity: of the sum of stresses on its motions, and of displacements.
  [[nodiscard]] double roundingOf(const Goal& goal) const {
    double sum = 0;
    for (size_t b = 0; b < model_.bodies.size(); ++b) {
      const Matrix strain = strainOf(b, goal.motion[b]);
      const Matrix& stress = state_.bodies[b].stress;
      for (int i = 0; i < model_.bodies[b].points(); ++i)
        sum += model_.bodies[b].weights()[i] * stress.col(i).cwiseAbs().dot(strain.col(i).cwiseAbs());
      if (const Vector& u = state_.bodies[b].displacement; u.size() > 0)
        sum += goal.force[b].lpNorm<1>() * u.lpNorm<Eigen::Infinity>();
    }
    return roundingOfSums * sum;
  }

  /// Forces at the nodes that are the change of the elastic energy of a body with its displacement.
  [[nodiscard]] Vector forceOfEnergy(size_t b) const {
    const Body& body = model_.bodies[b];
    const Linearisation& law = linearised_->law(static_cast<int>(b));
    Matrix strain;
    body.material().elasticStrain(state_.bodies[b].stress, strain);
    Matrix stress(strain.rows(), strain.cols());
    for (int i = 0; i < body.points(); ++i) stress.col(i) = stressOf(law, strain.col(i), i);
    return body.internalForce(stress);
  }

 private:
  /// The force of a node that slips does its work on its gap and mu times its slip, which are 0 together: the
  /// gap that is measured is that between the nodes.
  void closeSlipping(std::vector<Response>& z) const {
    for (size_t k = 0; k < model_.interfaces.size(); ++k) {
      const ContactInterface& interface = model_.interfaces[k];
      if (!interface.hasFriction()) continue;
      const auto& [nonmortar, mortar, coupling] = interface.pair();
      Vector& moved = z[nonmortar.body].displacement;
      const Vector slip = interface.slip(moved, z[mortar.body].displacement);
      Vector closing = Vector::Zero(interface.rows());
      for (int row = 0; row < interface.rows(); ++row) {
        if (state_.slipping[k][row] == 0) continue;
        const double along =
            interface.dimension() == 2
                ? state_.slipping[k][row] * slip[row]
                : on_.slipDirections[k][row].along.dot(slip.segment<2>(Eigen::Index{2} * row));
        closing[row] = interface.friction().coefficient * along;
      }
      moved += motionOfRows(interface, model_.bodies[nonmortar.body], closing);
    }
  }
  [[nodiscard]] Matrix strainOf(size_t b, const Vector& u) const {
    const Body& body = model_.bodies[b];
    Matrix strain = Matrix::Zero(body.material().components(), body.points());
    if (body.points() > 0 && !u.isZero(0))
      body.strain({u, Vector::Zero(u.size())}, nullptr, strain, 0, body.points());
    return strain;
  }
  /// By a step of no length, in which nothing flows.
  [[nodiscard]] Matrix elasticStress(size_t b, const Matrix& strain) const {
    const Body& body = model_.bodies[b];
    if (body.points() == 0) return strain;
    const Matrix zero = Matrix::Zero(strain.rows(), strain.cols());
    Linearisation law = body.material().room(body.points());
    body.material().linearise({0, zero, strain, false, &zero}, zero, law, 0, body.points());
    return law.predictor;
  }

  const Model& model_;
  const State& state_;
  State initial_;
  Iterate on_;
  std::optional<StepSystem::Linearised> linearised_;
  std::optional<StepSystem::Factorised> factors_;
  std::string obstacle_;
};

Goal goalOf(const Quantity& quantity, const Model& model, const Adjoint& adjoint) {
  Goal goal;
  for (const Body& body : model.bodies) goal.motion.emplace_back(Vector::Zero(body.dofs()));
  goal.force = goal.motion;
  Vector& motion = goal.motion[quantity.body];
  Vector& force = goal.force[quantity.body];
  const Body& body = model.bodies[quantity.body];
  switch (quantity.kind) {
    case Kind::contactForce:
      goal.betweenBodies = true;
      [[fallthrough]];
    case Kind::reaction:
      motion = motionOf(quantity, model);
      goal.moves = true;
      return goal;
    case Kind::meanPressure:
      for (size_t k = 0; k < model.interfaces.size(); ++k)
        if (const int b = model.interfaces[k].pair().nonmortar.body; !quantity.shares[k].isZero(0))
          goal.motion[b] += motionOfRows(model.interfaces[k], model.bodies[b], quantity.shares[k]);
      goal.moves = goal.betweenBodies = true;
      return goal;
    case Kind::displacement:
      for (const auto& [node, weight] : quantity.mean)
        force[body.dimension() * node + axisOf(quantity)] += weight;
      if (quantity.whole) force = body.sharesIn(motionNumber(quantity, body));
      return goal;
    default:  // the energy
      force = adjoint.forceOfEnergy(quantity.body);
      return goal;
  }
}

bool isLinear(Kind kind) {
  return kind == Kind::reaction || kind == Kind::contactForce || kind == Kind::displacement ||
         kind == Kind::meanPressure || kind == Kind::storedEnergy;
}

/// What the integral of a temperature over each triangle has beside the one at the points of the stress, over
/// its area; nothing where the points have all of it [K].
Vector missedHeat(const Body& body, double time) {
  const Datum& temperature = body.conditions().temperature;
  if (body.space() != nullptr || !body.heated() || temperature.degree <= body.degree()) return {};
  const ElementNodes& nodes = body.elementNodes();
  const std::vector<Point> places = body.places();
  Vector missed(static_cast<Eigen::Index>(body.elements()));
  const int points = body.pointsOfTriangle();
  for (size_t t = 0; t < body.elements(); ++t) {
    std::vector<Point> corners;
    for (int k = 0; k < 3; ++k) corners.push_back(nodes.places[nodes.of(t)[k]]);
    double sum = 0;
    for (int i = 0; i < points; ++i) {
      const Point& at = places[t * points + i];
      sum += temperature(at.x(), at.y(), time) / points;
    }
    missed[static_cast<Eigen::Index>(t)] = onTriangle(temperature, corners, time).mean() - sum;
  }
  return missed;
}

/// What bodies as meshed miss of their data: what is behind their sides, and heat.
struct Missed {
  Missed(const Model& model, double time) : sides(model, time) {
    for (const Body& body : model.bodies) heat.push_back(body.rigid() ? Vector() : missedHeat(body, time));
  }
  /// Of a linear quantity.
  [[nodiscard]] double changeOf(const Model& model, const State& state, const Goal& goal,
                                const std::vector<Response>& z) const {
    std::vector<Vector> moved;
    for (size_t b = 0; b < z.size(); ++b)
      moved.emplace_back(goal.betweenBodies ? Vector(z[b].displacement + goal.motion[b]) : z[b].displacement);
    double change = -sides.changeOf(state, z, moved);
    for (size_t b = 0; b < heat.size(); ++b) {
      const Body& body = model.bodies[b];
      const Matrix& expansion = body.conditions().expansion;
      for (int i = 0; heat[b].size() > 0 && i < body.points(); ++i)
        change += body.weights()[i] * heat[b][i / body.pointsOfTriangle()] *
                  expansion.col(i).dot(z[b].stress.col(i).head(expansion.rows()));
    }
    return change;
  }

  CurvedSides sides;
  std::vector<Vector> heat;  ///< by bodies
};

/// Of what needs no response.
QuantityError errorOfOther(const Quantity& quantity, const Model& model, CurrentMeshError& error) {
  constexpr double rounded = 1 - 1e-9;
  QuantityError of;
  if (quantity.kind == Kind::largestPressure || quantity.kind == Kind::largestMises) {
    of = errorOfLargest(quantity, model, error);
    of.size *= factorOfSafety;
  } else if (quantity.kind == Kind::contactLength || quantity.kind == Kind::contactArea) {
    of.size = errorOfContactSize(quantity, model, error.state());
    if (of.size > 0 && 2 * of.size > rounded * evaluate({quantity}, model, error.state()).front())
      of.obstacle = "contact is no wider than the elements at its ends";
  } else {
    of.obstacle = "it is summed over the steps, and errors are those of the last one";
  }
  return of;
}

/// What a mean pressure is smaller by on surfaces that are larger than meshed.
double growthOfMean(const Quantity& quantity, const Model& model, const State& state) {
  double growth = 0;
  double size = 0;
  for (size_t k = 0; k < model.interfaces.size(); ++k) {
    const ContactInterface& interface = model.interfaces[k];
    if (!isSide(interface.pair(), quantity.body, quantity.label)) continue;
    const Body& body = model.bodies[quantity.body];
    growth += growthOfSide(body, quantity.label, std::vector<char>(static_cast<size_t>(body.nodes()), 1));
    size += interface.lengths().sum();
  }
  return size > 0 ? growth / size * evaluate({quantity}, model, state).front() : 0;
}

/// The part e of the stress that is its estimated error is found with a recovered stress of which about the
/// same part is an error again: e^2 (1 + e^2).
double beyondRecovered(const std::vector<ErrorEstimate>& estimates) {
  double error = 0;
  double energy = 0;
  for (const ErrorEstimate& estimate : estimates) {
    error += estimate.error.sum();
    energy += estimate.energy;
  }
  return energy > 0 ? 1 + std::min(error / energy, 1.0) : 1;
}

QuantityError errorOfLinear(const Quantity& quantity, const Model& model, const Adjoint& adjoint,
                            const Missed& missed, CurrentMeshError& error) {
  QuantityError of;
  of.obstacle = adjoint.obstacle();
  if (!of.obstacle.empty()) return of;
  const Goal goal = goalOf(quantity, model, adjoint);
  const std::vector<Response> z = adjoint(goal);
  const CurrentMeshError::Estimates estimates = error.estimates();
  double sum = 0;
  double absolute = 0;
  for (const Vector& part : error.products(z)) {
    sum += part.sum();
    absolute += part.cwiseAbs().sum();
  }
  double beside = missed.changeOf(model, error.state(), goal, z);
  // U(u) = U(u_h) + a(u, u - u_h) - |u - u_h|^2/2, and z has the recovered stress of u. Where both terms
  // are as large, which of them is larger is not known.
  if (quantity.kind == Kind::storedEnergy) {
    const double square = (*estimates)[quantity.body].error.sum() / 2;
    sum = std::max(std::abs(sum - square), square);
    beside += missed.sides.energyBehind(quantity.body, error.state().bodies[quantity.body].stress);
  }
  if (quantity.kind == Kind::meanPressure) beside += growthOfMean(quantity, model, error.state());
  const double uncertain = std::abs(sum) > cancelled * absolute ? uncertainPart * absolute : 0;
  const double ofStress = (std::abs(sum) + uncertain) * beyondRecovered(*estimates);
  of.size = factorOfSafety * (ofStress + std::abs(beside) + adjoint.roundingOf(goal));
  return of;
}

}  // namespace

void withdraw(QuantityError& error, double value, const std::string& reason) {
  constexpr double decided = 1e-9;
  if (error.obstacle.empty() && error.size > decided * std::abs(value)) error = {0, reason, error.order};
}

std::vector<QuantityError> quantityErrors(const std::vector<Quantity>& quantities, const Model& model,
                                          StepTaker* taker, double begin, CurrentMeshError& error) {
  std::vector<QuantityError> errors;
  std::optional<Adjoint> adjoint;
  std::optional<Missed> missed;
  for (const Quantity& quantity : quantities) {
    QuantityError& of = errors.emplace_back();
    if (!isLinear(quantity.kind)) {
      of = errorOfOther(quantity, model, error);
    } else if (taker != nullptr) {
      if (!adjoint) {
        adjoint.emplace(model, *taker, begin);
        missed.emplace(model, error.state().time);
      }
      of = errorOfLinear(quantity, model, *adjoint, *missed, error);
    }
    if (!std::isfinite(of.size)) of = {0, "it is not finite", of.order};
  }
  return errors;
}

}  // namespace mortier
