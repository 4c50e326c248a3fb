#include "time/quantity.h"

#include <Eigen/LU>
#include <array>
#include <map>
#include <optional>
#include <utility>

#include "mesh/boundary_line.h"

namespace mortier {
namespace {

/// Forces at nodes, summed to a resultant and a moment.
struct Wrench {
  Point force = Point::Zero();
  double moment = 0;

  void add(const Point& at, const Point& by) {
    force += by;
    moment += at.x() * by.y() - at.y() * by.x();
  }
};

/// C' p, and T' t where there is friction, on a body (dofs): from one interface, or from those that have this label of it as a side.
Vector contactForces(const Model& model, const State& state, int body, std::optional<int> label) {
  Vector forces = Vector::Zero(model.bodies[body].dofs());
  for (size_t k = 0; k < model.interfaces.size(); ++k) {
    const ContactInterface& interface = model.interfaces[k];
    const auto& [nonmortar, mortar, coupling] = interface.pair();
    const auto is = [&](const ContactSide& side) {
      return side.body == body && (!label || side.label == *label);
    };
    if (is(nonmortar)) forces += interface.C1().transpose() * state.contactForce[k];
    if (is(mortar)) forces += interface.C2().transpose() * state.contactForce[k];
    if (!interface.rough()) continue;
    if (is(nonmortar)) forces += interface.T1().transpose() * state.frictionForce[k];
    if (is(mortar)) forces += interface.T2().transpose() * state.frictionForce[k];
  }
  return forces;
}

/// What the supports of each label exert on the body.
std::map<int, Wrench> reactions(const Model& model, const State& state, int b) {
  const Body& body = model.bodies[b];
  const Vector forces = body.internalForce(state.bodies[b].stress) +
                        contactForces(model, state, b, std::nullopt) - body.load(state.time);
  std::map<int, Wrench> result;
  for (const NodeSupport& support : body.supports().nodes()) {
    const Point force = forces.segment<2>(2 * support.node);
    std::array<double, 2> along{support.directions[0].dot(force), 0};
    if (support.count == 2) {
      Eigen::Matrix2d directions;
      directions << support.directions[0], support.directions[1];
      Eigen::Map<Point>(along.data()) = directions.inverse() * force;
    }
    for (int i = 0; i < support.count; ++i)
      result[body.conditions().displacements[support.conditions[i]].label].add(
          body.elementNodes().places[support.node], along[i] * support.directions[i]);
  }
  return result;
}

Wrench contactOn(const Model& model, const State& state, int body, int label) {
  const Vector forces = contactForces(model, state, body, label);
  const ElementNodes& nodes = model.bodies[body].elementNodes();
  const std::vector<int>& labels = model.bodies[body].mesh().boundaryLabels;
  Wrench result;
  std::vector<char> counted(nodes.count(), 0);
  for (const BoundaryStretch& stretch : nodes.boundary)
    for (const int node : stretch.nodes)
      if (labels[stretch.edge] == label && std::exchange(counted[node], 1) == 0)
        result.add(nodes.places[node], -forces.segment<2>(2 * node));
  return result;
}

double componentOf(const Wrench& wrench, const Quantity& quantity) {
  using Component = Quantity::Component;
  if (quantity.component == Component::moment)
    return wrench.moment - quantity.about.x() * wrench.force.y() + quantity.about.y() * wrench.force.x();
  return wrench.force[quantity.component == Component::x ? 0 : 1];
}

}  // namespace

std::string Quantity::unit() const {
  if (kind == Kind::displacement) return "m";
  return component == Component::moment ? "N" : "N/m";
}

std::vector<double> evaluate(const std::vector<Quantity>& quantities, const Model& model,
                             const State& state) {
  std::map<int, std::map<int, Wrench>> reactionsOf;
  std::vector<double> values;
  for (const Quantity& quantity : quantities) {
    if (quantity.kind == Quantity::Kind::displacement) {
      const int component = quantity.component == Quantity::Component::x ? 0 : 1;
      double value = 0;
      for (const auto& [node, weight] : quantity.mean)
        value += weight * state.bodies[quantity.body].displacement[2 * node + component];
      values.push_back(value);
    } else if (quantity.kind == Quantity::Kind::contactForce) {
      values.push_back(componentOf(contactOn(model, state, quantity.body, quantity.label), quantity));
    } else {
      if (reactionsOf.count(quantity.body) == 0)
        reactionsOf[quantity.body] = reactions(model, state, quantity.body);
      values.push_back(componentOf(reactionsOf[quantity.body][quantity.label], quantity));
    }
  }
  return values;
}

std::vector<std::pair<int, double>> meanAt(const TriangleMesh& mesh, const Point& point) {
  constexpr double rounding = 1e-9;  // of a triangle: a point on the boundary is inside
  const auto cross = [](const Point& u, const Point& v) { return u.x() * v.y() - u.y() * v.x(); };
  for (size_t t = 0; t < mesh.triangles.size(); ++t) {
    const auto& corners = mesh.triangles[t];
    const double area = doubleArea(mesh, static_cast<int>(t));
    std::vector<std::pair<int, double>> weights;
    for (int k = 0; k < 3; ++k) {
      const Point& a = mesh.vertices[corners[(k + 1) % 3]];
      const Point& b = mesh.vertices[corners[(k + 2) % 3]];
      weights.emplace_back(corners[k], cross(a - point, b - point) / area);
    }
    if (weights[0].second >= -rounding && weights[1].second >= -rounding && weights[2].second >= -rounding)
      return weights;
  }
  return {};
}

std::vector<std::pair<int, double>> meanOn(const TriangleMesh& mesh, int label) {
  std::map<int, double> lengths;
  double sum = 0;
  for (const auto& [a, b] : edgesOn(mesh, label)) {
    const double length = (mesh.vertices[b] - mesh.vertices[a]).norm();
    lengths[a] += length / 2;
    lengths[b] += length / 2;
    sum += length;
  }
  std::vector<std::pair<int, double>> weights;
  for (const auto& [vertex, length] : lengths) weights.emplace_back(vertex, length / sum);
  return weights;
}

}  // namespace mortier
