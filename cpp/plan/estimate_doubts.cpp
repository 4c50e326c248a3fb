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
                     " may flow and is more than 100 times stiffer than one that it touches: the estimate is "
                     "0.4 to 0.8 of its error");
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

std::vector<std::string> pointForceDoubts(const Model& model, const State& state) {
  constexpr double noticeable = 1e-6;  // its square is the part of the energy
  std::vector<std::string> doubts;
  for (size_t b = 0; b < model.bodies.size(); ++b) {
    const Body& body = model.bodies[b];
    const double largest = body.largestForce(state.bodies[b].stress);
    const auto placeOf = [&](const Condition& at) {
      return body.dimension() == 3 ? shortest(*at.point) : shortest(Point(at.point->head<2>()));
    };
    for (const Condition& load : body.conditions().tractions)
      if (load.point)
        doubts.push_back("body " + body.name() + " is loaded at " + placeOf(load) +
                         ", where the energy of a force is infinite");
    std::set<int> seen;
    for (const Condition& held : body.conditions().displacements) {
      if (!held.point || !seen.insert(firstSupport(body, held.label, held.point)).second) continue;
      std::vector<Quantity> components;
      for (int c = 0; c < body.dimension(); ++c) {
        components.push_back({"", Quantity::Kind::reaction, static_cast<int>(b)});
        components.back().point = held.point;
        components.back().component = static_cast<Quantity::Component>(c);
      }
      double square = 0;
      for (const double each : evaluate(components, model, state)) square += each * each;
      if (const double size = std::sqrt(square); size > noticeable * largest)
        doubts.push_back("body " + body.name() + " is held at " + placeOf(held) + " by a force of " +
                         digits(size) + (body.axisymmetric() || body.dimension() == 3 ? " N" : " N/m") +
                         ", whose energy at a point is infinite");
    }
  }
  return doubts;
}

}  // namespace mortier
