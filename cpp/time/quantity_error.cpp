#include "time/quantity_error.h"

#include <algorithm>
#include <cmath>
#include <optional>

#include "material/stress.h"
#include "time/corner_order.h"
#include "time/march.h"
#include "time/nodal_forces.h"
#include "time/quantity_motion.h"

namespace mortier {
namespace {

using Kind = Quantity::Kind;

/// The conditions of a linear quantity on z: motions that it has, on top of those of the response (dofs);
/// forces.
struct Goal {
  std::vector<Vector> motion, force;
  bool moves = false;          ///< whether there are motions
  bool betweenBodies = false;  ///< whether contact does not follow them
};

/// The linear problem in which contact stays as it is.
class Adjoint {
 public:
  Adjoint(const Model& model, StepTaker& taker, double begin)
      : model_(model), state_(taker.state()), initial_(initialState(model)), on_(startingIterate(state_)) {
    on_.active = taker.active();
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
    Disturbance to;
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
    return z;
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

/// Of the forces of contact on a part of a line: a motion of its nonmortar nodes along the normals.
Vector meanPressureMotion(const Quantity& quantity, const Model& model, int body) {
  Vector motion = Vector::Zero(model.bodies[body].dofs());
  for (size_t k = 0; k < model.interfaces.size(); ++k) {
    const ContactInterface& interface = model.interfaces[k];
    if (interface.pair().nonmortar.body != body) continue;
    for (int row = 0; row < interface.rows(); ++row)
      motion.segment<2>(2 * interface.nonmortarNodes()[row]) +=
          quantity.shares[k][row] * interface.normals()[row];
  }
  return motion;
}

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
      for (size_t b = 0; b < model.bodies.size(); ++b)
        goal.motion[b] = meanPressureMotion(quantity, model, static_cast<int>(b));
      goal.moves = goal.betweenBodies = true;
      return goal;
    case Kind::displacement:
      for (const auto& [node, weight] : quantity.mean)
        force[body.dimension() * node + axisOf(quantity)] += weight;
      if (quantity.whole)
        for (Eigen::Index dof = 0; dof < force.size(); ++dof)
          force[dof] = body.motionOf(Vector::Unit(
              force.size(), dof))[quantity.component == Quantity::Component::rotation ? 2 : axisOf(quantity)];
      return goal;
    default:  // the energy
      force = adjoint.forceOfEnergy(quantity.body);
      return goal;
  }
}

/// The triangles around a node of a body.
std::vector<size_t> trianglesAt(const Body& body, int node) {
  const ElementNodes& nodes = body.elementNodes();
  std::vector<size_t> triangles;
  for (size_t t = 0; t < body.mesh().triangles.size(); ++t)
    if (std::find(nodes.of(t), nodes.of(t) + nodes.perTriangle(), node) != nodes.of(t) + nodes.perTriangle())
      triangles.push_back(t);
  return triangles;
}

/// How far the recovered stress at a node is from the pressure there.
double errorOfPressure(const PlaceOfLargest& largest, const Model& model, CurrentSpaceError& error) {
  const ContactInterface& interface = model.interfaces[largest.interface];
  const auto b = static_cast<size_t>(interface.pair().nonmortar.body);
  const Body& body = model.bodies[b];
  const int node = interface.nonmortarNodes()[largest.row];
  const Point& n = interface.normals()[largest.row];
  const size_t triangle = trianglesAt(body, node).front();
  const int* nodes = body.elementNodes().of(triangle);
  const Eigen::Index place = std::find(nodes, nodes + body.elementNodes().perTriangle(), node) - nodes;
  const Eigen::Vector3d s = toCartesian(error.recoveredIn(b, triangle).col(place).head<3>());
  const double across = n.x() * n.x() * s[0] + n.y() * n.y() * s[1] + 2 * n.x() * n.y() * s[2];
  return std::abs(largest.value + across);
}

/// How far the largest recovered von Mises stress at the nodes of the triangle is from it.
double errorOfMises(const PlaceOfLargest& largest, const Quantity& quantity, const Model& model,
                    CurrentSpaceError& error) {
  const Body& body = model.bodies[quantity.body];
  const auto b = static_cast<size_t>(quantity.body);
  const Matrix recovered = error.recoveredIn(b, static_cast<size_t>(largest.row / body.pointsOfTriangle()));
  double most = 0;
  for (const auto& column : recovered.colwise())
    most = std::max(most, vonMises(column.head(body.material().tensorComponents())));
  return std::abs(most - largest.value);
}

/// The order of unbounded stresses at the place of a largest value, as measured, or else as known from the
/// corner there.
QuantityError errorOfLargest(const Quantity& quantity, const Model& model, const State& state,
                             CurrentSpaceError& error) {
  QuantityError of;
  const std::optional<PlaceOfLargest> largest = placeOfLargest(quantity, model, state);
  if (model.bodies.front().dimension() == 3) {
    of.obstacle = "of largest values in space there is none";
  } else if (largest) {
    const Point place = largest->place.head<2>();
    const bool pressure = quantity.kind == Kind::largestPressure;
    const int b = pressure ? model.interfaces[largest->interface].pair().nonmortar.body : quantity.body;
    const bool flows =
        !pressure && model.bodies[b].material().flows(state.bodies[b].stress, static_cast<int>(largest->row));
    of.order = unboundedOrder(model, state, place);
    if (of.order == 0 && !pressure && !flows)
      of.order = cornerOrder(model.bodies[b], state.bodies[b].stress, place);
    if (of.order > 0)
      of.obstacle = "stresses are unbounded there";
    else if (contactEndsAt(model, state, place))
      of.obstacle = "stresses may be unbounded there, where contact ends at a corner";
    else if (model.bodies[b].rigid())
      of.obstacle = "the side is rigid";
    else
      of.size =
          pressure ? errorOfPressure(*largest, model, error) : errorOfMises(*largest, quantity, model, error);
  }
  return of;
}

/// Half of the row functions at the ends of what presses.
double errorOfContactLength(const Quantity& quantity, const Model& model, const State& state) {
  double error = 0;
  for (size_t k = 0; k < model.interfaces.size(); ++k) {
    if (!isSide(model.interfaces[k], quantity.body, quantity.label)) continue;
    const Vector lengths = model.interfaces[k].lengths();
    const Vector& p = state.contactForce[k];
    for (Eigen::Index i = 0; i + 1 < p.size(); ++i)
      if ((p[i] > 0) != (p[i + 1] > 0)) error += (p[i] > 0 ? lengths[i] : lengths[i + 1]) / 2;
  }
  return error;
}

bool isLinear(Kind kind) {
  return kind == Kind::reaction || kind == Kind::contactForce || kind == Kind::displacement ||
         kind == Kind::meanPressure || kind == Kind::storedEnergy;
}

/// Of what needs no response.
QuantityError errorOfOther(const Quantity& quantity, const Model& model, const State& state,
                           CurrentSpaceError& error) {
  QuantityError of;
  if (quantity.kind == Kind::largestPressure || quantity.kind == Kind::largestMises)
    return errorOfLargest(quantity, model, state, error);
  if (quantity.kind != Kind::contactLength)
    of.obstacle = "it is summed over the steps, and errors are those of the last one";
  else if (model.bodies.front().dimension() == 3)
    of.obstacle = "of areas of contact there is none";
  else
    of.size = errorOfContactLength(quantity, model, state);
  return of;
}

QuantityError errorOfLinear(const Quantity& quantity, const Model& model, const Adjoint& adjoint,
                            CurrentSpaceError& error) {
  QuantityError of;
  of.obstacle = adjoint.obstacle();
  if (!of.obstacle.empty()) return of;
  double sum = 0;
  for (const Vector& part : error.products(adjoint(goalOf(quantity, model, adjoint)))) sum += part.sum();
  // U(u) = U(u_h) + a(u, u - u_h) - |u - u_h|^2/2, and z has the recovered stress of u.
  if (quantity.kind == Kind::storedEnergy) sum -= (*error.estimates())[quantity.body].error.sum() / 2;
  of.size = std::abs(sum);
  return of;
}

}  // namespace

std::vector<QuantityError> quantityErrors(const std::vector<Quantity>& quantities, const Model& model,
                                          StepTaker* taker, double begin, CurrentSpaceError& error) {
  const State& state = error.state();
  std::vector<QuantityError> errors;
  std::optional<Adjoint> adjoint;
  for (const Quantity& quantity : quantities) {
    QuantityError& of = errors.emplace_back();
    if (!isLinear(quantity.kind)) {
      of = errorOfOther(quantity, model, state, error);
    } else if (taker != nullptr) {
      if (!adjoint) adjoint.emplace(model, *taker, begin);
      of = errorOfLinear(quantity, model, *adjoint, error);
    }
    if (!std::isfinite(of.size)) of = {0, "it is not finite", of.order};
  }
  return errors;
}

}  // namespace mortier
