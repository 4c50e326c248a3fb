// Bodies under hydrostatic pressure whose contact lines are mapped to any shape.
#pragma once

#include <array>
#include <numbers>

#include "theory/scenes.h"

namespace mortier::stacks {

using namespace scenes;

using Map = std::function<Point(const Point&)>;

constexpr double pi = std::numbers::pi;
constexpr Elasticity elasticity{1000, 0.3};
constexpr double pressure = 10;
inline TriangleMesh mapped(int cells, double lower, const Map& map) {
  TriangleMesh mesh =
      crissCrossMesh({.lower = {0, lower}, .upper = {1, lower + 1}, .cellsX = cells, .cellsY = cells});
  for (Point& x : mesh.vertices) x = map(x);
  validate(mesh);
  return mesh;
}

/// What holds and loads the sides that are not in contact.
enum class SideConditions { pressed, held };

/// A body under hydrostatic pressure, u = strain (x, y) on `supports`. No shear acts on any line, so the
/// state is one of frictionless contact whatever Gamma_C looks like.
inline Body hydrostatic(const std::string& name, TriangleMesh mesh, const std::vector<int>& held,
                        const std::vector<int>& pressed) {
  const double strain = -pressure * (1 - elasticity.poisson) / elasticity.young;
  Conditions conditions;
  for (const int label : held)
    for (const int c : {0, 1})
      conditions.displacements.push_back(
          {label, c, [=](double x, double y, double t) { return t * strain * (c == 0 ? x : y); }});
  for (const int label : pressed)
    conditions.tractions.push_back(
        {label, alongNormal, [](double, double, double t) { return -pressure * t; }});
  return {name, std::move(mesh), elasticMaterial(elasticity), std::move(conditions)};
}

/// Bodies on each other from the top down, each contact between the bottom of one and the top of the next.
inline Model stack(const std::vector<int>& cells, const Map& map, CouplingKind coupling, bool upperNonmortar,
                   SideConditions sides, const InterfaceOptions& options = {}) {
  Model model;
  for (size_t b = 0; b < cells.size(); ++b) {
    std::vector<int> held;
    std::vector<int> pressed;
    (sides == SideConditions::held ? held : pressed) = {left, right};
    // Nothing else keeps a body between two others from sliding.
    if (b > 0 && b + 1 < cells.size()) held.push_back(left);
    if (b == 0) held.push_back(top);
    if (b + 1 == cells.size()) held.push_back(bottom);
    model.bodies.push_back(hydrostatic("body" + std::to_string(b),
                                       mapped(cells[b], -static_cast<double>(b), map), held, pressed));
  }
  for (size_t b = 1; b < cells.size(); ++b) {
    const ContactSide above{static_cast<int>(b) - 1, bottom};
    const ContactSide below{static_cast<int>(b), top};
    addInterface(model, {upperNonmortar ? above : below, upperNonmortar ? below : above, coupling}, options);
  }
  return model;
}

inline double patchError(const Model& model, const State& state) {
  const Eigen::Vector3d exact = fromCartesian({-pressure, -pressure, 0});
  double worst = 0;
  for (size_t b = 0; b < model.bodies.size(); ++b)
    worst = std::max(worst, (state.bodies[b].stress.colwise() - exact).cwiseAbs().maxCoeff() / pressure);
  return worst;
}

/// Force and moment about the origin of the contact forces of an interface on both bodies.
inline Eigen::Vector3d contactWrench(const Model& model, const State& state, size_t k) {
  const ContactInterface& interface = model.interfaces[k];
  Eigen::Vector3d sum = Eigen::Vector3d::Zero();
  std::vector<Vector> f;
  const std::array<int, 2> bodies{interface.pair().nonmortar.body, interface.pair().mortar.body};
  for (const int b : bodies) f.push_back(Vector::Zero(model.bodies[b].dofs()));
  interface.subtractForces(state.contactForce[k], f[0], f[1]);
  if (interface.hasFriction()) interface.subtractFriction(state.frictionForce[k], f[0], f[1]);
  for (size_t side = 0; side < 2; ++side)
    for (int v = 0; v < model.bodies[bodies[side]].nodes(); ++v) {
      const Point& x = model.bodies[bodies[side]].mesh().vertices[v];
      const Point at = f[side].segment<2>(2 * v);
      sum += Eigen::Vector3d(at.x(), at.y(), x.x() * at.y() - x.y() * at.x());
    }
  return sum;
}

/// The largest resultant and moment of the contact forces on all bodies, over their sum.
inline double imbalance(const Model& model, const State& state) {
  double worst = 0;
  for (size_t k = 0; k < model.interfaces.size(); ++k)
    worst = std::max(
        worst, contactWrench(model, state, k).cwiseAbs().maxCoeff() / state.contactForce[k].cwiseAbs().sum());
  return worst;
}

inline Map turned(
    double angle, const Map& map = [](const Point& x) { return x; }) {
  const Eigen::Matrix2d rotation{{std::cos(angle), -std::sin(angle)}, {std::sin(angle), std::cos(angle)}};
  return [=](const Point& x) { return Point(rotation * map(x)); };
}

}  // namespace mortier::stacks
