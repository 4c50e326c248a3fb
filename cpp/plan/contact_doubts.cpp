// Contacts that the meshes do not resolve.
#include <algorithm>
#include <cmath>
#include <limits>
#include <optional>
#include <queue>
#include <utility>

#include "base/dense_templates.h"
#include "base/formatted.h"
#include "plan/estimate_doubts.h"
#include "time/nodal_forces.h"

namespace mortier {
namespace {

/// The rows of a surface, and those with which each has a triangle in common.
class RowGraph {
 public:
  RowGraph(const ContactInterface& interface, const Body& nonmortar)
      : neighbours_(interface.rows()), spacing_(interface.mortarSpacing()) {
    for (const int node : interface.nonmortarNodes()) places_.push_back(nonmortar.placeOfNode(node));
    const Eigen::SparseMatrix<double>& functions = interface.surfacePoints().rows;
    forEachEntry(Eigen::SparseMatrix<double>(functions.transpose() * functions),
                 [&](int row, int other, double) {
                   if (row != other) neighbours_[row].push_back(other);
                 });
  }

  /// As cellsOfContact() below: of the pressed rows around the deepest of each contact, the steps to the
  /// nearest open one less a half. A step is no more than a cell of the mortar side.
  [[nodiscard]] double cells(const Vector& p) const {
    using Reached = std::pair<double, int>;
    std::priority_queue<Reached, std::vector<Reached>, std::greater<>> next;
    std::vector<double> steps(neighbours_.size(), std::numeric_limits<double>::infinity());
    for (size_t row = 0; row < steps.size(); ++row)
      if (!(p[static_cast<Eigen::Index>(row)] > 0)) next.emplace(steps[row] = 0, static_cast<int>(row));
    while (!next.empty()) {
      const auto [so_far, row] = next.top();
      next.pop();
      if (so_far > steps[row]) continue;
      for (const int other : neighbours_[row])
        if (const double to = so_far + step(row, other); to < steps[other])
          next.emplace(steps[other] = to, other);
    }
    double fewest = std::numeric_limits<double>::infinity();
    std::vector<char> seen(steps.size(), 0);
    for (size_t first = 0; first < steps.size(); ++first) {
      std::vector<int> contact{static_cast<int>(first)};
      double deepest = 0;
      while (!contact.empty()) {
        const int row = contact.back();
        contact.pop_back();
        if (!(p[row] > 0) || std::exchange(seen[row], 1) != 0) continue;
        deepest = std::max(deepest, steps[row]);
        contact.insert(contact.end(), neighbours_[row].begin(), neighbours_[row].end());
      }
      if (deepest > 0) fewest = std::min(fewest, deepest > 1 ? deepest - 0.5 : 0);
    }
    return fewest;
  }

  /// As alternationOf() below, with the linear function that fits the neighbours best.
  [[nodiscard]] double alternation(const Vector& p, const Vector& pressure) const {
    const auto inside = [&](int row) {
      return p[row] > 0 && neighbours_[row].size() >= 3 &&
             std::all_of(neighbours_[row].begin(), neighbours_[row].end(), [&](int i) { return p[i] > 0; });
    };
    std::vector<std::optional<double>> off(neighbours_.size());
    for (size_t row = 0; row < off.size(); ++row)
      if (inside(static_cast<int>(row))) off[row] = offFit(static_cast<int>(row), pressure);
    double most = 0;
    for (size_t row = 0; row < off.size(); ++row) {
      const std::vector<int>& around = neighbours_[row];
      if (!off[row] || !std::all_of(around.begin(), around.end(), [&](int i) { return off[i].has_value(); }))
        continue;
      double mean = 0;
      for (const int i : around) mean += *off[i] / static_cast<double>(around.size());
      most = std::max(most, std::abs(*off[row] - mean) / 2);
    }
    return most > 0 ? most / pressure.maxCoeff() : 0;
  }

 private:
  [[nodiscard]] double step(int row, int other) const {
    const double length = (places_[row] - places_[other]).norm();
    const double cell = spacing_.size() > 0 ? std::max(spacing_[row], spacing_[other]) : 0;
    return length / std::max(length, cell);
  }

  [[nodiscard]] double offFit(int row, const Vector& pressure) const {
    const std::vector<int>& around = neighbours_[row];
    Matrix terms(around.size(), 4);
    Vector values(around.size());
    for (size_t k = 0; k < around.size(); ++k) {
      const auto i = static_cast<Eigen::Index>(k);
      terms.row(i) << 1, (places_[around[k]] - places_[row]).transpose();
      values[i] = pressure[around[k]];
    }
    const double size = terms.rightCols<3>().cwiseAbs().maxCoeff();
    terms.rightCols<3>() /= size;
    // A surface has two slopes: the third is that of least norm.
    Eigen::CompleteOrthogonalDecomposition<Matrix> factors;
    factors.setThreshold(0.05);
    return pressure[row] - factors.compute(terms).solve(values)[0];
  }

  std::vector<std::vector<int>> neighbours_;
  std::vector<SpacePoint> places_;
  const Vector& spacing_;
};

/// Cells of the coarser side on half the width of the contact that has fewest, of those that end within a
/// side; infinite where none does. Around a node whose neighbours are open it is 0.
double cellsOfContact(const ContactInterface& interface, const Vector& p) {
  const std::vector<int>& nodes = interface.nonmortarNodes();
  const Vector lengths = interface.lengths();
  const Vector& spacing = interface.mortarSpacing();
  const auto follows = [&](int row) {  // whether the row before is that of the node before
    return row > 0 && row < interface.rows() && nodes[row] != nodes[row - 1];
  };
  double fewest = std::numeric_limits<double>::infinity();
  for (int first = 0, end = 0; first < interface.rows(); first = std::max(end, first + 1)) {
    if (!(p[first] > 0)) continue;
    double width = 0;
    double cell = 0;
    for (end = first; end < interface.rows() && p[end] > 0 && (end == first || follows(end)); ++end) {
      width += lengths[end];
      cell = std::max(cell, lengths[end]);
      if (spacing.size() > 0) cell = std::max(cell, spacing[end]);
    }
    const bool open = follows(first) && interface.faces(first - 1);
    const bool opens = follows(end) && interface.faces(end);
    if (open || opens)
      fewest = std::min(fewest, end == first + 1 ? 0 : width / cell / (open && opens ? 2 : 1));
  }
  return fewest;
}

/// The part of the largest nodal pressure by which pressures alternate from node to node inside of contact:
/// half of the difference of d_i = pi_i - (what its neighbours give there) from the mean of d at these [-].
double alternationOf(const ContactInterface& interface, const std::vector<Point>& places, const Vector& p) {
  const std::vector<int>& nodes = interface.nonmortarNodes();
  const Vector pressure = interface.contactPressure(p);
  const auto distance = [&](Eigen::Index i) { return (places[nodes[i + 1]] - places[nodes[i]]).norm(); };
  const auto d = [&](Eigen::Index i) {
    const double part = distance(i - 1) / (distance(i - 1) + distance(i));
    return pressure[i] - (1 - part) * pressure[i - 1] - part * pressure[i + 1];
  };
  double most = 0;
  Eigen::Index closed = 0;  // rows up to here that are of one closed stretch
  for (Eigen::Index i = 0; i < p.size(); ++i) {
    const bool next = closed == 0 || nodes[i] != nodes[i - 1];  // at a corner another part begins
    closed = p[i] > 0 ? (next ? closed + 1 : 1) : 0;
    if (closed >= 5) most = std::max(most, std::abs(d(i - 2) - (d(i - 3) + d(i - 1)) / 2) / 2);
  }
  return most > 0 ? most / pressure.maxCoeff() : 0;
}

/// The moment of the contact forces that the motion of their places makes beside what it is where the places
/// move alike, over that of friction: equilibrium is that of places as drawn [-].
double momentOfMotion(const ContactInterface& interface, const Body& body, const State& state, size_t k) {
  const int n = body.dimension();
  Vector friction = Vector::Zero(body.dofs());
  forEachEntry(interface.T1(),
               [&](int row, int dof, double value) { friction[dof] += value * state.frictionForce[k][row]; });
  Vector force = friction;
  forEachEntry(interface.C1(),
               [&](int row, int dof, double value) { force[dof] += value * state.contactForce[k][row]; });
  const Vector& u = state.bodies[interface.pair().nonmortar.body].displacement;
  const auto at = [&](const Vector& of, int node) {
    SpacePoint vector(0, 0, 0);
    vector.head(n) = of.segment(n * node, n);
    return vector;
  };
  double size = 0;
  SpacePoint place(0, 0, 0);
  SpacePoint moved(0, 0, 0);
  for (int node = 0; node < body.nodes(); ++node) {
    const double weight = at(force, node).norm();
    size += weight;
    place += weight * body.placeOfNode(node);
    moved += weight * at(u, node);
  }
  SpacePoint moment(0, 0, 0);
  double ofFriction = 0;
  for (int node = 0; node < body.nodes() && size > 0; ++node) {
    moment += (at(u, node) - moved / size).cross(at(force, node));
    ofFriction += (body.placeOfNode(node) - place / size).norm() * at(friction, node).norm();
  }
  return ofFriction > 0 ? moment.norm() / ofFriction : 0;
}

}  // namespace

std::vector<ContactDoubt> contactDoubts(const Model& model, const State& state, double largestForce) {
  // Cells on the half width with which nodal pressures are right to 5 % up to 0.85 of it, of displacements as
  // of row functions, and of quadratic ones with hat functions. Off by less than 150 % over the cells.
  constexpr double enough[] = {8, 12};
  // Nodal pressures were off by more than 5 % only beyond these.
  constexpr double rough = 0.05;
  constexpr double roughOfOthers = 0.015;  // where conditions are not stabilised
  constexpr double rounding = 1e-9;
  constexpr double resolved = 2;     // so is the force to 20 %
  constexpr double overlaps = 1e-9;  // area of an overlap over the square of a length, or volume
  constexpr double exact = 1e-9;
  constexpr double turned = 0.02;
  std::vector<ContactDoubt> doubts;
  using Unknown = ContactDoubt::Unknown;
  for (size_t k = 0; k < model.interfaces.size(); ++k) {
    const ContactInterface& interface = model.interfaces[k];
    const auto& [nonmortar, mortar, coupling] = interface.pair();
    const std::string name =
        formatted("contact of label %d of body ", nonmortar.label) + model.bodies[nonmortar.body].name();
    const auto doubt = [&](Unknown unknown, const std::string& text) {
      doubts.push_back({k, unknown, name + text});
    };
    const Vector& p = state.contactForce[k];
    if (const double off = interface.patchError(); off > exact)
      doubt(Unknown::nothing, formatted(": variant = \"interpolation\" makes nodal forces of a uniform "
                                        "pressure that are off by up to %.2g %% on the mortar side",
                                        100 * off));
    if (!p.isZero(0) && p.sum() <= rounding * largestForce) continue;
    const Body& body = model.bodies[nonmortar.body];
    if (interface.follows() && interface.hasFriction())
      if (const double off = momentOfMotion(interface, body, state, k); off > turned)
        doubt(Unknown::nothing, formatted(": forces act where the bodies have moved to, and they are in "
                                          "equilibrium as drawn; the moment of friction is off by %.2g %%",
                                          100 * off));
    const std::optional<RowGraph> surface =
        body.dimension() == 3 ? std::optional<RowGraph>(std::in_place, interface, body) : std::nullopt;
    const double cells = surface ? surface->cells(p) : cellsOfContact(interface, p);
    if (cells < resolved)
      doubt(Unknown::force, ": too few cells for its width, pressures and the force are not resolved");
    else if (cells < enough[rowDegree(coupling, body.degree()) < body.degree()])
      doubt(Unknown::nothing,
            formatted(": %.2g cells on the half width, nodal pressures near its ends to %.0f %%", cells,
                      std::ceil(150 / cells)));
    if (const double by = interface.pressureRoughness(p);
        by > (interface.stabilised() ? rough : roughOfOthers))
      doubt(Unknown::nothing, formatted(": not resolved by the coarser side, in an element of which nodal "
                                        "pressures change by %.0f %% of the largest",
                                        100 * by));
    else if (const double to = surface ? surface->alternation(p, interface.contactPressure(p))
                                       : alternationOf(interface, body.elementNodes().places, p);
             to > rough)
      doubt(Unknown::pressures,
            formatted(": not resolved, nodal pressures alternate by %.0f %% of the largest", 100 * to));
    if (!p.isZero(0)) continue;
    const double area = interface.interpenetration(state.bodies[nonmortar.body].displacement,
                                                   state.bodies[mortar.body].displacement, state.time);
    const double cell = std::pow(interface.lengths().maxCoeff(), 1.0 / (interface.dimension() - 1));
    if (area > overlaps * std::pow(cell, interface.dimension()))
      doubt(Unknown::force,
            ": the sides overlap between their nodes without a force, finer cells resolve it");
  }
  return doubts;
}

bool leavesUnknown(const ContactDoubt& doubt, const Quantity& quantity, bool ofPart, const Model& model) {
  using Kind = Quantity::Kind;
  using Unknown = ContactDoubt::Unknown;
  const ContactInterface& interface = model.interfaces[doubt.interface];
  const auto& [nonmortar, mortar, coupling] = interface.pair();
  if (quantity.kind == Kind::largestMises)
    return doubt.unknown == Unknown::force &&
           (quantity.body == nonmortar.body || quantity.body == mortar.body);
  if (!isSide(interface.pair(), quantity.body, quantity.label)) return false;
  switch (quantity.kind) {
    case Kind::largestPressure:
      return doubt.unknown != Unknown::nothing;
    case Kind::meanPressure:
      return doubt.unknown == Unknown::force || (ofPart && doubt.unknown == Unknown::pressures);
    case Kind::contactForce:
      return doubt.unknown == Unknown::force;
    default:
      return false;
  }
}

}  // namespace mortier
