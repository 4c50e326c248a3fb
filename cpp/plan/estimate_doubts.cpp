#include "plan/estimate_doubts.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <set>
#include <utility>

#include "base/digits.h"
#include "base/formatted.h"
#include "plan/loads.h"
#include "scene/document.h"
#include "scene/resolve.h"
#include "time/quantity.h"

namespace mortier {
namespace {

/// The bodies that flow and touch one that is much softer, each once.
std::vector<std::string> stiffAndFlowing(const SceneDescription& scene, const Model& model) {
  constexpr double much = 100;
  const auto stiffest = [](const std::vector<const MaterialDescription*>& materials) {
    double young = 0;
    for (const MaterialDescription* material : materials) young = std::max(young, material->elasticity.young);
    return young;
  };
  std::set<int> found;
  for (const ContactInterface& interface : model.interfaces) {
    const int one = interface.pair().nonmortar.body;
    const int two = interface.pair().mortar.body;
    for (const auto& [stiff, soft] : {std::pair(one, two), std::pair(two, one)}) {
      const auto materials = materialsOf(scene.bodies[stiff]);
      if (mayFlow(scene.bodies[stiff]) &&
          stiffest(materials) > much * stiffest(materialsOf(scene.bodies[soft])))
        found.insert(stiff);
    }
  }
  std::vector<std::string> doubts;
  for (const int b : found)
    doubts.push_back("body " + model.bodies[b].name() +
                     " may flow and is more than 100 times stiffer than one that it touches; of its error it "
                     "finds 0.4 to 0.8");
  return doubts;
}

}  // namespace

bool meshesMatch(const ContactInterface& interface) {
  std::vector<int> vertex(interface.rows(), -1);
  std::set<int> all;
  for (int row = 0; row < interface.rows(); ++row)
    for (ConstraintRows::InnerIterator entry(interface.C2(), row); entry; ++entry) {
      const int node = static_cast<int>(entry.col()) / 2;
      int& seen = vertex[row];
      if (seen >= 0 && seen != node) return false;
      seen = node;
      all.insert(seen);
    }
  // Those between the first and the last that are seen, in the order of the line, less ends that are held.
  const std::vector<int>& nodes = interface.mortarNodes();
  size_t first = nodes.size();
  size_t last = 0;
  for (size_t i = 0; i < nodes.size(); ++i) {
    if (all.count(nodes[i]) == 0) continue;
    first = std::min(first, i);
    last = i;
  }
  return all.empty() || last + 1 - first <= all.size() + static_cast<size_t>(interface.heldEnds());
}

std::vector<std::string> estimateDoubts(const SceneDescription& scene, const Model& model) {
  constexpr double incompressible = 0.49;
  constexpr double crossed = 0.9;  // of the triangles
  std::vector<std::string> doubts = stiffAndFlowing(scene, model);
  const auto falseStresses = [&](const ContactInterface& interface) {
    return !model.bodies[interface.pair().mortar.body].rigid() &&
           interface.pair().coupling == CouplingKind::interpolation && !meshesMatch(interface);
  };
  if (std::any_of(model.interfaces.begin(), model.interfaces.end(), falseStresses))
    doubts.emplace_back(
        "interpolation on meshes that do not match makes false stresses, of which it finds 0.34 to 0.8");
  for (size_t b = 0; b < model.bodies.size() && scene.plane != Plane::stress; ++b) {
    const auto materials = materialsOf(scene.bodies[b]);
    const bool keepsVolume = std::any_of(
        materials.begin(), materials.end(),
        [](const MaterialDescription* material) { return material->elasticity.poisson >= incompressible; });
    if (keepsVolume && scene.degree > 1)
      doubts.push_back(
          "body " + model.bodies[b].name() +
          " is nearly incompressible, of whose error with quadratic displacements it finds 0.5 to 1.2");
    else if (keepsVolume && !(crossedPart(model.bodies[b].mesh()) > crossed))
      doubts.push_back("body " + model.bodies[b].name() +
                       " is nearly incompressible and locks on cells with one diagonal, of which it finds "
                       "0.38 to 1.2");
  }
  return doubts;
}

namespace {

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

}  // namespace

std::vector<std::string> contactDoubts(const Model& model, const State& state, double largestForce) {
  // Cells on the half width with which nodal pressures are right to 5 % up to 0.85 of it, of displacements as
  // of row functions, and of quadratic ones with hat functions. Off by less than 150 % over the cells.
  constexpr double enough[] = {8, 12};
  // Nodal pressures were off by more than 5 % only beyond these.
  constexpr double rough = 0.05;
  constexpr double roughOfOthers = 0.015;  // where conditions are not stabilised
  constexpr double rounding = 1e-9;
  constexpr double resolved = 2;     // so is the force to 20 %
  constexpr double overlaps = 1e-9;  // area of an overlap over the square of a length
  std::vector<std::string> doubts;
  for (size_t k = 0; k < model.interfaces.size(); ++k) {
    const ContactInterface& interface = model.interfaces[k];
    if (interface.dimension() != 2) continue;
    const auto& [nonmortar, mortar, coupling] = interface.pair();
    const std::string name =
        formatted("contact of label %d of body ", nonmortar.label) + model.bodies[nonmortar.body].name();
    const Vector& p = state.contactForce[k];
    if (!p.isZero(0) && p.sum() <= rounding * largestForce) continue;
    const double cells = cellsOfContact(interface, p);
    if (cells < resolved)
      doubts.push_back(name + ": too few cells for its width, pressures and the force are not resolved");
    else if (cells < enough[rowDegree(coupling, model.bodies[nonmortar.body].degree()) <
                            model.bodies[nonmortar.body].degree()])
      doubts.push_back(name +
                       formatted(": %.2g cells on the half width, nodal pressures near its ends to %.0f %%",
                                 cells, std::ceil(150 / cells)));
    if (const double by = interface.pressureRoughness(p);
        by > (interface.stabilised() ? rough : roughOfOthers))
      doubts.push_back(name + formatted(": not resolved by the coarser side, in an element of which nodal "
                                        "pressures change by %.0f %% of the largest",
                                        100 * by));
    else if (const double to =
                 alternationOf(interface, model.bodies[nonmortar.body].elementNodes().places, p);
             to > rough)
      doubts.push_back(
          name + formatted(": not resolved, nodal pressures alternate by %.0f %% of the largest", 100 * to));
    if (!p.isZero(0)) continue;
    const double area = interface.interpenetration(state.bodies[nonmortar.body].displacement,
                                                   state.bodies[mortar.body].displacement, state.time);
    const double cell = interface.lengths().maxCoeff();
    if (area > overlaps * cell * cell)
      doubts.push_back(name +
                       ": the sides overlap between their nodes without a force, finer cells resolve it");
  }
  return doubts;
}

std::vector<std::string> pointForceDoubts(const Model& model, const State& state) {
  constexpr double noticeable = 1e-6;  // its square is the part of the energy
  std::vector<std::string> doubts;
  for (size_t b = 0; b < model.bodies.size(); ++b) {
    const Body& body = model.bodies[b];
    const double largest = body.largestForce(state.bodies[b].stress);
    std::set<int> seen;
    for (const PrescribedDisplacement& held : body.conditions().displacements) {
      if (!held.point || !seen.insert(firstSupport(body, held.label, held.point)).second) continue;
      Quantity along{"", Quantity::Kind::reaction, static_cast<int>(b)};
      along.point = held.point;
      Quantity across = along;
      across.component = Quantity::Component::y;
      const std::vector<double> force = evaluate({along, across}, model, state);
      const double size = std::hypot(force[0], force[1]);
      if (size > noticeable * largest)
        doubts.push_back("body " + body.name() + " is held at " + shortest(*held.point) + " by a force of " +
                         digits(size) + (body.axisymmetric() ? " N" : " N/m") +
                         ", whose energy at a point is infinite");
    }
  }
  return doubts;
}

}  // namespace mortier
