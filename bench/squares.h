// The bodies of the benchmarks: two unit squares, one on the other, on criss-cross meshes whose cell counts
// are about 1 to sqrt2 and not nested, in the note's state of uniform compression well beyond yield.
#pragma once

#include <cmath>
#include <memory>
#include <string>
#include <vector>

#include "material/perzyna.h"
#include "mesh/generate.h"
#include "solver/model.h"
#include "solver/state.h"

namespace mortier::bench {

constexpr Elasticity elasticity{3e11, 0.3};
constexpr double viscosity = 10;     // [Pa s]
constexpr double yieldStress = 1;    // [Pa]
constexpr double loadRate = 10;      // pressure on top [Pa/s]
constexpr double flowingTime = 0.5;  // the bodies yield at 0.1 [s]
constexpr double timeStep = 0.01;    // [s]

struct Cells {
  int upper = 0;
  int lower = 0;
  [[nodiscard]] int triangles() const { return 4 * (upper * upper + lower * lower); }
};

/// Counts, none a multiple of the other, for about that many triangles.
inline Cells cellsFor(double triangles) {
  if (triangles < 2e3) return {10, 14};
  if (triangles < 5e4) return {29, 41};
  if (triangles < 5e5) return {91, 129};
  return {289, 408};
}

inline TriangleMesh square(bool upper, int cells) {
  const double y = upper ? 0 : -1;
  return crissCrossMesh({{0, y}, {1, y + 1}, cells, cells});
}

/// One of the two bodies; `fixed` also holds the upper one against the vertical motion that contact prevents.
inline Body squareBody(bool upper, const Cells& cells, std::shared_ptr<const Material> material, bool fixed) {
  const Function zero = [](double, double, double) { return 0.0; };
  Conditions conditions;
  conditions.displacements.push_back({4, 0, zero});
  if (!upper || fixed) conditions.displacements.push_back({upper ? 3 : 1, 1, zero});
  if (upper) conditions.tractions.push_back({3, 1, [](double, double, double t) { return -loadRate * t; }});
  return {upper ? "upper" : "lower", square(upper, upper ? cells.upper : cells.lower), std::move(material),
          std::move(conditions)};
}

inline Model twoSquares(const Cells& cells, Projection projection, CouplingKind coupling) {
  const auto material = perzynaMaterial(elasticity, {viscosity, yieldStress, projection});
  Model model;
  model.bodies.push_back(squareBody(true, cells, material, false));
  model.bodies.push_back(squareBody(false, cells, material, false));
  model.interfaces.emplace_back(ContactPair{{0, 1}, {1, 3}, coupling}, model.bodies[0].mesh(),
                                model.bodies[1].mesh());
  return model;
}

/// The uniform compression (0, -loadRate t, 0) at flowingTime, displacements counted from there.
inline State flowing(const Model& model) {
  State state;
  state.time = flowingTime;
  const double pressure = loadRate * flowingTime;
  const double component = pressure * std::sqrt(0.5);
  for (const Body& body : model.bodies) {
    Matrix stress(3, body.points());
    stress.colwise() = Eigen::Vector3d(-component, component, 0);
    Matrix elastic;
    body.material().elasticStrain(stress, elastic);
    state.bodies.push_back({Vector::Zero(body.dofs()), std::move(stress), -elastic});
  }
  for (const ContactInterface& interface : model.interfaces) {
    state.contactForce.emplace_back(interface.mass() * Vector::Constant(interface.rows(), pressure));
    state.gap.push_back(Vector::Zero(interface.rows()));
    state.frictionWorkOf.push_back(0);
  }
  return state;
}

}  // namespace mortier::bench
