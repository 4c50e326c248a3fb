#include "time/quantity.h"

#include <algorithm>
#include <map>

#include "material/back_stress.h"
#include "material/stress.h"
#include "time/nodal_forces.h"
#include "time/quantity_motion.h"

namespace mortier {
namespace {

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

PlaceOfLargest largestPressure(const Model& model, const State& state, const Quantity& quantity) {
  PlaceOfLargest largest;
  for (size_t k = 0; k < model.interfaces.size(); ++k) {
    const ContactInterface& interface = model.interfaces[k];
    if (!isSide(interface.pair(), quantity.body, quantity.label)) continue;
    const Body& body = model.bodies[interface.pair().nonmortar.body];
    const Vector pressure = interface.contactPressure(state.contactForce[k]);
    for (Eigen::Index i = 0; i < pressure.size(); ++i)
      if (pressure[i] > largest.value)
        largest = {pressure[i], body.placeOfNode(interface.nonmortarNodes()[i]), k, i};
  }
  return largest;
}

PlaceOfLargest largestMises(const Model& model, const State& state, const Quantity& quantity) {
  PlaceOfLargest largest;
  const Body& body = model.bodies[quantity.body];
  const Matrix& stress = state.bodies[quantity.body].stress;
  const int tensor = body.material().tensorComponents();
  for (Eigen::Index i = 0; i < stress.cols(); ++i)
    if (const double value = vonMises(stress.col(i).head(tensor)); value > largest.value)
      largest = {value, body.placeOfPoint(static_cast<int>(i)), 0, i};
  return largest;
}

/// Integral of the row functions of the nodes that press, which sum to one; in space over the surface.
double contactLength(const Model& model, const State& state, const Quantity& quantity) {
  double length = 0;
  for (size_t k = 0; k < model.interfaces.size(); ++k) {
    const ContactInterface& interface = model.interfaces[k];
    if (!isSide(interface.pair(), quantity.body, quantity.label)) continue;
    const Vector lengths = interface.lengths();
    for (Eigen::Index i = 0; i < lengths.size(); ++i)
      if (state.contactForce[k][i] > 0) length += lengths[i];
  }
  return length;
}

double frictionWork(const Model& model, const State& state, const Quantity& quantity) {
  double work = 0;
  for (size_t k = 0; k < model.interfaces.size(); ++k)
    if (isSide(model.interfaces[k].pair(), quantity.body, quantity.label)) work += state.frictionWorkOf[k];
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
      if (component >= Component::rotationX) return "rad";
      [[fallthrough]];
    case Kind::contactLength:
      return units.length;
    case Kind::contactArea:
      return units.area();
    case Kind::largestPressure:
    case Kind::meanPressure:
    case Kind::largestMises:
      return units.stress;
    case Kind::reaction:
    case Kind::contactForce:
      return isMoment(component) ? units.moment() : units.forcePerDepth();
    default:
      return units.energyPerDepth();
  }
}

bool ofLabel(Quantity::Kind kind) {
  using Kind = Quantity::Kind;
  return kind == Kind::reaction || kind == Kind::contactForce || kind == Kind::displacement ||
         kind == Kind::largestPressure || kind == Kind::contactLength || kind == Kind::contactArea ||
         kind == Kind::frictionWork || kind == Kind::meanPressure;
}

bool hasComponent(Quantity::Kind kind) {
  using Kind = Quantity::Kind;
  return kind == Kind::reaction || kind == Kind::contactForce || kind == Kind::displacement;
}

bool isMoment(Quantity::Component component) {
  using enum Quantity::Component;
  return component == momentX || component == momentY || component == momentZ;
}

bool needsWork(const Quantity& quantity) {
  using Kind = Quantity::Kind;
  return quantity.kind == Kind::dissipatedEnergy || quantity.kind == Kind::work ||
         quantity.kind == Kind::externalWork || quantity.kind == Kind::thermalWork;
}

std::vector<double> evaluate(const std::vector<Quantity>& quantities, const Model& model,
                             const State& state) {
  using Kind = Quantity::Kind;
  std::map<int, Vector> supporting;  // r by bodies
  const auto reaction = [&](const Quantity& quantity) {
    const auto [of, isNew] = supporting.try_emplace(quantity.body);
    if (isNew) {
      const Body& body = model.bodies[quantity.body];
      of->second = body.internalForce(state.bodies[quantity.body].stress) - body.load(state.time) +
                   contactForces(model, forcesOf(state), quantity.body);
    }
    return motionOf(quantity, model).dot(of->second);
  };
  const auto displacement = [&](const Quantity& quantity) {
    const int component = axisOf(quantity);
    const int dimension = model.bodies[quantity.body].dimension();
    if (const Body& body = model.bodies[quantity.body]; quantity.whole)
      return body.motionOf(state.bodies[quantity.body].displacement)[motionNumber(quantity, body)];
    double value = 0;
    for (const auto& [node, weight] : quantity.mean)
      value += weight * state.bodies[quantity.body].displacement[dimension * node + component];
    return value;
  };
  const auto valueOf = [&](const Quantity& quantity) {
    const BodyState& body = state.bodies[quantity.body];
    switch (quantity.kind) {
      case Kind::displacement:
        return displacement(quantity);
      case Kind::contactForce:
        return motionOf(quantity, model)
            .dot(contactForces(model, forcesOf(state), quantity.body,
                               quantity.whole ? std::nullopt : std::optional(quantity.label)));
      case Kind::storedEnergy:
        return storedEnergy(model.bodies[quantity.body], body);
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
      case Kind::contactArea:
        return contactLength(model, state, quantity);
      case Kind::largestMises:
        return largestMises(model, state, quantity).value;
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

std::optional<PlaceOfLargest> placeOfLargest(const Quantity& quantity, const Model& model,
                                             const State& state) {
  std::optional<PlaceOfLargest> largest;
  if (quantity.kind == Quantity::Kind::largestPressure) largest = largestPressure(model, state, quantity);
  if (quantity.kind == Quantity::Kind::largestMises) largest = largestMises(model, state, quantity);
  return largest && largest->value > 0 ? largest : std::nullopt;
}

std::optional<SpacePoint> placeOf(const Quantity& quantity, const Model& model, const State& state) {
  const std::optional<PlaceOfLargest> largest = placeOfLargest(quantity, model, state);
  return largest ? std::optional(largest->place) : std::nullopt;
}

double largestPressureError(const Quantity& quantity, const Model& model, const State& state) {
  const PlaceOfLargest largest = largestPressure(model, state, quantity);
  if (!(largest.value > 0)) return 0;
  const ContactInterface& interface = model.interfaces[largest.interface];
  const Eigen::Index row = largest.row;
  const int b = interface.pair().nonmortar.body;
  const Body& body = model.bodies[b];
  const int node = interface.nonmortarNodes()[row];
  const SpacePoint& n = interface.normals()[row];
  const ElementNodes& nodes = body.elementNodes();
  const size_t triangles = body.mesh().triangles.size();
  const size_t points = body.points() / triangles;
  double sum = 0;
  double area = 0;
  for (size_t t = 0; t < triangles; ++t) {
    if (std::find(nodes.of(t), nodes.of(t) + nodes.perElement(), node) == nodes.of(t) + nodes.perElement())
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
