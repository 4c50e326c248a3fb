#include "time/largest_error.h"

#include <algorithm>
#include <cmath>
#include <optional>
#include <utility>
#include <vector>

#include "material/stress.h"
#include "time/curve_error.h"
#include "time/nodal_forces.h"
#include "time/quantity_motion.h"
#include "time/singular_places.h"

namespace mortier {
namespace {

using Kind = Quantity::Kind;

/// The element of a stress.
size_t elementOf(const Body& body, const PlaceOfLargest& largest) {
  return static_cast<size_t>(largest.row) / (static_cast<size_t>(body.points()) / body.elements());
}

/// From the place of a stress to the farthest node of its element.
double reachOf(const Body& body, const PlaceOfLargest& largest) {
  double reach = 0;
  for (const int node : body.nodesOf(elementOf(body, largest)))
    reach = std::max(reach, (body.placeOfNode(node) - largest.place).norm());
  return reach;
}

/// n . s n of a stress at a point of a body.
double across(const Body& body, const Vector& stress, const SpacePoint& n) {
  if (body.dimension() == 3) {
    const SpaceStress s = toSpaceCartesian(stress.head<6>());
    return n.x() * n.x() * s[0] + n.y() * n.y() * s[1] + n.z() * n.z() * s[2] +
           2 * (n.x() * n.y() * s[3] + n.x() * n.z() * s[4] + n.y() * n.z() * s[5]);
  }
  const Eigen::Vector3d s = toCartesian(stress.head<3>());
  return n.x() * n.x() * s[0] + n.y() * n.y() * s[1] + 2 * n.x() * n.y() * s[2];
}

/// The estimated error of the stress in the elements that have one of some nodes, over it.
double errorAround(const Body& body, size_t b, const std::vector<int>& nodes, CurrentMeshError& error) {
  const Vector& errors = (*error.estimates())[b].error;
  const Matrix& stress = error.state().bodies[b].stress;
  Matrix strain;
  body.material().elasticStrain(stress, strain);
  const size_t points = body.points() / body.elements();
  double square = 0;
  double energy = 0;
  for (size_t element = 0; element < body.elements(); ++element) {
    if (std::ranges::none_of(body.nodesOf(element),
                             [&](int node) { return std::ranges::count(nodes, node) > 0; }))
      continue;
    square += errors[static_cast<Eigen::Index>(element)];
    for (size_t point = element * points; point < (element + 1) * points; ++point) {
      const auto i = static_cast<Eigen::Index>(point);
      energy += body.weights()[i] * stress.col(i).dot(strain.col(i));
    }
  }
  return energy > 0 ? std::sqrt(square / energy) : 0;
}

/// How far the recovered stress at a node is from the pressure there, at least the part of it by which the
/// stress around it is off.
double errorOfPressure(const PlaceOfLargest& largest, const Model& model, CurrentMeshError& error) {
  const ContactInterface& interface = model.interfaces[largest.interface];
  const auto b = static_cast<size_t>(interface.pair().nonmortar.body);
  const Body& body = model.bodies[b];
  const int node = interface.nonmortarNodes()[largest.row];
  const std::vector<int>& nodes = body.nodesOfElements();
  const auto found = std::ranges::find(nodes, node);
  if (found == nodes.end()) return 0;
  const double recovered =
      across(body, error.recovered(b).col(found - nodes.begin()), interface.normals()[largest.row]);
  return std::max(std::abs(largest.value + recovered), largest.value * errorAround(body, b, {node}, error));
}

/// How far the largest recovered von Mises stress at the nodes of the element, and that of the body, are from
/// it, at least the part of it by which the stress around it is off.
double errorOfMises(const PlaceOfLargest& largest, const Quantity& quantity, const Model& model,
                    CurrentMeshError& error) {
  const Body& body = model.bodies[quantity.body];
  const auto b = static_cast<size_t>(quantity.body);
  const size_t element = elementOf(body, largest);
  const std::span<const int> nodes = body.nodesOf(element);
  const Matrix recovered = error.recovered(b);
  const Eigen::Index tensor = body.material().tensorComponents();
  double own = 0;
  double all = 0;
  for (Eigen::Index i = 0; i < recovered.cols(); ++i) {
    const double there = vonMises(recovered.col(i).head(tensor));
    all = std::max(all, there);
    if (static_cast<size_t>(i) / nodes.size() == element) own = std::max(own, there);
  }
  return std::max({std::abs(own - largest.value), std::abs(all - largest.value),
                   largest.value * errorAround(body, b, {nodes.begin(), nodes.end()}, error)});
}

}  // namespace

QuantityError errorOfLargest(const Quantity& quantity, const Model& model, CurrentMeshError& error) {
  QuantityError of;
  const State& state = error.state();
  const std::optional<PlaceOfLargest> largest = placeOfLargest(quantity, model, state);
  if (!largest) return of;
  const bool pressure = quantity.kind == Kind::largestPressure;
  const int b = pressure ? model.interfaces[largest->interface].pair().nonmortar.body : quantity.body;
  const auto corner = [&](int body) {
    return cornerAt(model.bodies[body], state.bodies[body].stress, largest->place);
  };
  const bool ends =
      contactEndsAt(model, state, largest->place, pressure ? 0 : reachOf(model.bodies[b], *largest));
  of.order = unboundedOrder(model, state, largest->place);
  // A peak of a few elements in the middle of smooth contact has an order as measured, too.
  if (pressure && !ends && !corner(b) && !corner(model.interfaces[largest->interface].pair().mortar.body))
    of.order = 0;
  if (of.order > 0)
    of.obstacle = "stresses are unbounded there";
  else if (!pressure && corner(b))
    of.obstacle = "stresses may be unbounded there, at a corner or an end of a support";
  else if (ends)
    of.obstacle = "stresses may be unbounded there, where contact ends at a corner";
  else if (model.bodies[b].rigid())
    of.obstacle = "the side is rigid";
  else
    of.size =
        pressure ? errorOfPressure(*largest, model, error) : errorOfMises(*largest, quantity, model, error);
  return of;
}

double errorOfContactSize(const Quantity& quantity, const Model& model, const State& state) {
  double error = 0;
  for (size_t k = 0; k < model.interfaces.size(); ++k) {
    const ContactInterface& interface = model.interfaces[k];
    if (!isSide(interface.pair(), quantity.body, quantity.label)) continue;
    const Vector sizes = interface.lengths();
    const Vector& p = state.contactForce[k];
    const ContactSide& side = interface.pair().nonmortar;
    std::vector<char> pressed(static_cast<size_t>(model.bodies[side.body].nodes()), 0);
    for (Eigen::Index row = 0; row < p.size(); ++row)
      if (p[row] > 0) pressed[interface.nonmortarNodes()[row]] = 1;
    error += 2 * std::abs(growthOfSide(model.bodies[side.body], side.label, pressed));
    if (interface.dimension() == 2) {
      for (Eigen::Index i = 0; i + 1 < p.size(); ++i)
        if ((p[i] > 0) != (p[i + 1] > 0)) error += (p[i] > 0 ? sizes[i] : sizes[i + 1]) / 2;
      continue;
    }
    // Rows whose functions meet at a point of the surface are neighbours.
    const Eigen::SparseMatrix<double, Eigen::RowMajor> functions = interface.surfacePoints().rows;
    std::vector<char> atBorder(static_cast<size_t>(p.size()), 0);
    for (Eigen::Index point = 0; point < functions.rows(); ++point) {
      bool open = false;
      for (decltype(functions)::InnerIterator each(functions, point); each; ++each)
        open = open || !(p[each.col()] > 0);
      for (decltype(functions)::InnerIterator each(functions, point); each && open; ++each)
        if (p[each.col()] > 0) atBorder[each.col()] = 1;
    }
    for (Eigen::Index row = 0; row < p.size(); ++row)
      if (atBorder[row] != 0) error += sizes[row] / 2;
  }
  return error;
}

}  // namespace mortier
