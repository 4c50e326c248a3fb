#include "time/quantity.h"

#include <Eigen/LU>
#include <algorithm>
#include <array>
#include <map>
#include <utility>

#include "material/back_stress.h"
#include "material/stress.h"
#include "time/nodal_forces.h"

namespace mortier {
namespace {

/// Forces at nodes, summed to a resultant and a moment.
struct Wrench {
  SpacePoint force = SpacePoint::Zero();
  double moment = 0;  ///< about the axis across the plane

  void add(const SpacePoint& at, const SpacePoint& by) {
    force += by;
    moment += at.x() * by.y() - at.y() * by.x();
  }
};

/// A vector at a node (dofs); z = 0 in the plane.
SpacePoint at(const Vector& nodal, int node, int dimension) {
  SpacePoint vector = SpacePoint::Zero();
  vector.head(dimension) = nodal.segment(static_cast<Eigen::Index>(dimension) * node, dimension);
  return vector;
}

void addSpaceReactions(const Body& body, const Vector& forces, std::map<int, Wrench>& result) {
  for (const SpaceSupport& support : body.space()->supports()) {
    // By the prescribed directions, which need not be orthogonal: D' r = f on their span.
    const Eigen::Index n = support.count;
    const Matrix span = support.frame.topRows(n);
    const Matrix inSpan = support.directions.topRows(n) * span.transpose();  // lower triangular
    const Vector along =
        inSpan.transpose().triangularView<Eigen::Upper>().solve(Vector(span * at(forces, support.node, 3)));
    for (int i = 0; i < support.count; ++i) {
      const SpaceCondition& held = body.space()->conditions().displacements[support.conditions[i]];
      result[firstSupport(body, held.label, {}, held.point)].add(
          body.placeOfNode(support.node), along[i] * SpacePoint(support.directions.row(i)));
    }
  }
}

/// What the supports of each label and each point exert on the body, by the first of their conditions.
std::map<int, Wrench> reactions(const Model& model, const State& state, int b) {
  const Body& body = model.bodies[b];
  Vector forces = body.internalForce(state.bodies[b].stress) - body.load(state.time);
  model.sumAtNodes(b, forces);
  forces += contactForces(model, state.contactForce, state.frictionForce, b);
  std::map<int, Wrench> result;
  if (body.space() != nullptr) addSpaceReactions(body, forces, result);
  const auto inPlane = [](const Point& p) { return SpacePoint(p.x(), p.y(), 0); };
  if (body.rigid()) {
    const Eigen::Vector3d held = body.heldForce(forces);
    Wrench& all = result[-1];
    all.add(inPlane(body.conditions().rigid->at), inPlane(held.head<2>()));
    all.moment += held[2];
  }
  for (const NodeSupport& support : body.supports().nodes()) {
    const Point force = forces.segment<2>(2 * support.node);
    std::array<double, 2> along{support.directions[0].dot(force), 0};
    if (support.count == 2) {
      Eigen::Matrix2d directions;
      directions << support.directions[0], support.directions[1];
      Eigen::Map<Point>(along.data()) = directions.inverse() * force;
    }
    for (int i = 0; i < support.count; ++i) {
      const PrescribedDisplacement& held = body.conditions().displacements[support.conditions[i]];
      if (held.onAxis) continue;
      result[firstSupport(body, held.label, held.point)].add(body.placeOfNode(support.node),
                                                             inPlane(along[i] * support.directions[i]));
    }
  }
  return result;
}

Wrench contactOn(const Model& model, const State& state, int body, std::optional<int> label) {
  const Vector forces = contactForces(model, state.contactForce, state.frictionForce, body, label);
  const Body& of = model.bodies[body];
  Wrench result;
  for (const int node : of.boundaryNodes(label))
    result.add(of.placeOfNode(node), -at(forces, node, of.dimension()));
  return result;
}

/// x, y or z as a number.
int axisOf(const Quantity& quantity) {
  using Component = Quantity::Component;
  return quantity.component == Component::x ? 0 : quantity.component == Component::z ? 2 : 1;
}

double componentOf(const Wrench& wrench, const Quantity& quantity) {
  using Component = Quantity::Component;
  if (quantity.component == Component::moment)
    return wrench.moment - quantity.about.x() * wrench.force.y() + quantity.about.y() * wrench.force.x();
  return wrench.force[axisOf(quantity)];
}

/// Of elasticity and of what hardens.
double storedEnergy(const Body& body, const BodyState& state) {
  Matrix strain;
  body.material().elasticStrain(state.stress, strain);
  double energy = 0;
  for (int i = 0; i < body.points(); ++i) {
    const PointVector back = backStressOf(body.material(), state.viscoplasticStrain, i);
    energy += body.weights()[i] / 2 *
              (state.stress.col(i).dot(strain.col(i)) + back.dot(state.viscoplasticStrain.col(i)));
  }
  return energy;
}

/// The largest value of a field, and where it is.
struct Largest {
  double value = 0;
  std::optional<SpacePoint> place = {};
  size_t interface = 0;  ///< of a pressure, and the row of C
  Eigen::Index row = 0;
  void raise(double other, const SpacePoint& at, size_t ofInterface = 0, Eigen::Index ofRow = 0) {
    if (other > value) *this = {other, at, ofInterface, ofRow};
  }
};

Largest largestPressure(const Model& model, const State& state, const Quantity& quantity) {
  Largest largest;
  for (size_t k = 0; k < model.interfaces.size(); ++k) {
    const ContactInterface& interface = model.interfaces[k];
    if (!isSide(interface, quantity.body, quantity.label)) continue;
    const Body& body = model.bodies[interface.pair().nonmortar.body];
    const Vector pressure = interface.contactPressure(state.contactForce[k]);
    for (Eigen::Index i = 0; i < pressure.size(); ++i)
      largest.raise(pressure[i], body.placeOfNode(interface.nonmortarNodes()[i]), k, i);
  }
  return largest;
}

Largest largestMises(const Model& model, const State& state, const Quantity& quantity) {
  Largest largest;
  const Body& body = model.bodies[quantity.body];
  const Matrix& stress = state.bodies[quantity.body].stress;
  const int tensor = body.material().tensorComponents();
  for (Eigen::Index i = 0; i < stress.cols(); ++i)
    if (const double value = vonMises(stress.col(i).head(tensor)); value > largest.value)
      largest.raise(value, body.placeOfPoint(static_cast<int>(i)));
  return largest;
}

/// Integral of the row functions of the nodes that press, which sum to one.
double contactLength(const Model& model, const State& state, const Quantity& quantity) {
  double length = 0;
  for (size_t k = 0; k < model.interfaces.size(); ++k) {
    const ContactInterface& interface = model.interfaces[k];
    if (!isSide(interface, quantity.body, quantity.label)) continue;
    const Vector lengths = interface.lengths();
    for (Eigen::Index i = 0; i < lengths.size(); ++i)
      if (state.contactForce[k][i] > 0) length += lengths[i];
  }
  return length;
}

double frictionWork(const Model& model, const State& state, const Quantity& quantity) {
  double work = 0;
  for (size_t k = 0; k < model.interfaces.size(); ++k)
    if (isSide(model.interfaces[k], quantity.body, quantity.label)) work += state.frictionWorkOf[k];
  return work;
}

double meanPressure(const State& state, const Quantity& quantity) {
  double mean = 0;
  for (size_t k = 0; k < quantity.shares.size(); ++k) mean += quantity.shares[k].dot(state.contactForce[k]);
  return mean;
}

}  // namespace

std::string Quantity::unit(const Units& units) const {
  switch (kind) {
    case Kind::displacement:
      if (component == Component::rotation) return "rad";
      [[fallthrough]];
    case Kind::contactLength:
      return units.length;
    case Kind::largestPressure:
    case Kind::meanPressure:
    case Kind::largestMises:
      return units.stress;
    case Kind::reaction:
    case Kind::contactForce:
      return component == Component::moment ? units.force : units.forcePerDepth();
    default:
      return units.energyPerDepth();
  }
}

bool ofLabel(Quantity::Kind kind) {
  using Kind = Quantity::Kind;
  return kind == Kind::reaction || kind == Kind::contactForce || kind == Kind::displacement ||
         kind == Kind::largestPressure || kind == Kind::contactLength || kind == Kind::frictionWork ||
         kind == Kind::meanPressure;
}

bool hasComponent(Quantity::Kind kind) {
  using Kind = Quantity::Kind;
  return kind == Kind::reaction || kind == Kind::contactForce || kind == Kind::displacement;
}

bool needsWork(const Quantity& quantity) {
  using Kind = Quantity::Kind;
  return quantity.kind == Kind::dissipatedEnergy || quantity.kind == Kind::work ||
         quantity.kind == Kind::externalWork || quantity.kind == Kind::thermalWork;
}

int firstSupport(const Body& body, int label, const std::optional<Point>& point,
                 const std::optional<SpacePoint>& pointInSpace) {
  if (body.space() != nullptr) {
    const std::vector<SpaceCondition>& held = body.space()->conditions().displacements;
    const auto found = std::find_if(held.begin(), held.end(), [&](const SpaceCondition& each) {
      return each.point == pointInSpace && (pointInSpace || each.label == label);
    });
    return found == held.end() ? -1 : static_cast<int>(found - held.begin());
  }
  const std::vector<PrescribedDisplacement>& held = body.conditions().displacements;
  const auto found = std::find_if(held.begin(), held.end(), [&](const PrescribedDisplacement& each) {
    return point ? each.point == point : each.actsOn(label);
  });
  return found == held.end() ? -1 : static_cast<int>(found - held.begin());
}

std::vector<double> evaluate(const std::vector<Quantity>& quantities, const Model& model,
                             const State& state) {
  using Kind = Quantity::Kind;
  std::map<int, std::map<int, Wrench>> reactionsOf;
  const auto reaction = [&](const Quantity& quantity) {
    if (reactionsOf.count(quantity.body) == 0)
      reactionsOf[quantity.body] = reactions(model, state, quantity.body);
    const int support = quantity.whole ? -1
                                       : firstSupport(model.bodies[quantity.body], quantity.label,
                                                      quantity.point, quantity.pointInSpace);
    return componentOf(reactionsOf[quantity.body][support], quantity);
  };
  const auto displacement = [&](const Quantity& quantity) {  // of the nodes of this rank
    const int component = axisOf(quantity);
    const int dimension = model.bodies[quantity.body].dimension();
    if (quantity.whole) {
      const bool turns = quantity.component == Quantity::Component::rotation;
      return model.bodies[quantity.body].motionOf(
          state.bodies[quantity.body].displacement)[turns ? 2 : component];
    }
    double value = 0;
    for (const auto& [node, weight] : quantity.mean)
      value += weight * state.bodies[quantity.body].displacement[dimension * node + component];
    return value;
  };
  const auto valueOf = [&](const Quantity& quantity) {
    const BodyState& body = state.bodies[quantity.body];
    switch (quantity.kind) {
      case Kind::displacement:
        return model.sum(displacement(quantity));
      case Kind::contactForce:
        return componentOf(contactOn(model, state, quantity.body,
                                     quantity.whole ? std::nullopt : std::optional(quantity.label)),
                           quantity);
      case Kind::storedEnergy:
        return model.sum(storedEnergy(model.bodies[quantity.body], body));
      case Kind::dissipatedEnergy:
        return body.work.dissipated;
      case Kind::work:
        return body.work.external + body.work.contact;
      case Kind::externalWork:
        return body.work.external;
      case Kind::thermalWork:
        return body.work.thermal;
      case Kind::largestPressure:
        return largestPressure(model, state, quantity).value;
      case Kind::contactLength:
        return contactLength(model, state, quantity);
      case Kind::largestMises:
        return model.largest(largestMises(model, state, quantity).value);
      case Kind::frictionWork:
        return frictionWork(model, state, quantity);
      case Kind::meanPressure:
        return meanPressure(state, quantity);
      default:
        return reaction(quantity);
    }
  };
  std::vector<double> values;
  values.reserve(quantities.size());
  for (const Quantity& quantity : quantities) values.push_back(valueOf(quantity));
  return values;
}

Quantity ofParts(const Quantity& quantity, const Model& model) {
  Quantity own = quantity;
  own.mean.clear();
  const BodyPart& part = model.parts[quantity.body];
  for (const auto& [node, weight] : quantity.mean) {
    const auto at = std::lower_bound(part.cut.nodes.begin(), part.cut.nodes.end(), node);
    const auto number = static_cast<int>(at - part.cut.nodes.begin());
    if (at != part.cut.nodes.end() && *at == node && part.owned[number] != 0)
      own.mean.emplace_back(number, weight);
  }
  return own;
}

std::optional<SpacePoint> placeOf(const Quantity& quantity, const Model& model, const State& state) {
  if (quantity.kind == Quantity::Kind::largestPressure) return largestPressure(model, state, quantity).place;
  if (quantity.kind == Quantity::Kind::largestMises) return largestMises(model, state, quantity).place;
  return std::nullopt;
}

double largestPressureError(const Quantity& quantity, const Model& model, const State& state) {
  const Largest largest = largestPressure(model, state, quantity);
  if (!largest.place) return 0;
  const ContactInterface& interface = model.interfaces[largest.interface];
  const Eigen::Index row = largest.row;
  const int b = interface.pair().nonmortar.body;
  const Body& body = model.bodies[b];
  const int node = interface.nonmortarNodes()[row];
  const Point& n = interface.normals()[row];
  const ElementNodes& nodes = body.elementNodes();
  const size_t triangles = body.mesh().triangles.size();
  const size_t points = body.points() / triangles;
  double sum = 0;
  double area = 0;
  for (size_t t = 0; t < triangles; ++t) {
    if (std::find(nodes.of(t), nodes.of(t) + nodes.perTriangle(), node) == nodes.of(t) + nodes.perTriangle())
      continue;
    for (size_t i = t * points; i < (t + 1) * points; ++i) {
      const Eigen::Vector3d s =
          toCartesian(state.bodies[b].stress.col(static_cast<Eigen::Index>(i)).head<3>());
      sum += body.weights()[i] * (n.x() * n.x() * s[0] + n.y() * n.y() * s[1] + 2 * n.x() * n.y() * s[2]);
      area += body.weights()[i];
    }
  }
  const double spread = state.contactForce[largest.interface][row] / interface.lengths()[row];
  return std::max(std::abs(largest.value - spread), std::abs(largest.value + sum / area));
}

}  // namespace mortier
