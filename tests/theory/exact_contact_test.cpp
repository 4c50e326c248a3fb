// Contact problems with known solutions whose extent of contact is not known beforehand: Hertz's line contact
// on curved meshes, and receding contact.
#include <gtest/gtest.h>

#include <iostream>
#include <numbers>

#include "material/deviatoric.h"
#include "theory/scenes.h"

namespace mortier::exact_contact_test {

using namespace scenes;

constexpr double pi = std::numbers::pi;

struct Measured {
  double peak = 0;   ///< largest pressure
  double width = 0;  ///< half of the width of contact: twice the radius of gyration of the forces
  double last = 0;   ///< distance of the last closed node from the middle
  double worst = 0;  ///< largest deviation of a nodal pressure within half of the half-width
  double least = 0;  ///< least nodal pressure
};

// ---- Hertz: the lower half of a disc on a block, N and mm

constexpr double radius = 50;
constexpr double discYoung = 210000;
constexpr double blockYoung = 70000;
constexpr double nu = 0.3;

/// b = sqrt(4 F R / (pi E*)), p0 = 2 F / (pi b), 1/E* = 1/E1 + 1/E2, in plane strain over 1 - nu^2.
Measured hertz(double force, Plane plane, double block = blockYoung) {
  const double modulus = 1 / (1 / discYoung + 1 / block) / (plane == Plane::strain ? 1 - nu * nu : 1);
  const double b = std::sqrt(4 * force * radius / (pi * modulus));
  return {2 * force / (pi * b), b, b};
}

/// The flat side of the disc is moved down. \returns pressure and width over those of Hertz for the same
/// force.
/// \param cellsOfBlock  in place of a block whose meshes suit; they grow less
/// \param upTo  part of the half-width in which pressures are compared
/// \param stabilised  whether conditions are (Stabilisation)
Measured solveHertz(int cells, CouplingKind coupling, bool discNonmortar, Plane plane = Plane::stress,
                    double young = blockYoung, int cellsOfBlock = 0, double upTo = 0.5,
                    bool stabilised = false) {
  const auto material = [&](double stiffness) { return elasticMaterial({stiffness, nu}, plane); };
  constexpr int arc = 1;
  constexpr int flat = 2;
  constexpr double core = 10;
  constexpr double depth = 1.8;
  TriangleMesh disc =
      halfDiscMesh({.lowest = {0, 0}, .radius = radius, .core = core, .cells = cells}, Cut::both);
  // Not the nodes of the disc, and neither mesh much coarser than the other where they touch: pressures
  // of conditions that one body cannot distinguish alternate from node to node, on a wall those of any that
  // is finer.
  const int blockCells = cellsOfBlock > 0 ? cellsOfBlock : cells * (young > blockYoung ? 3 : 5);
  const double grading = cellsOfBlock > 0 ? 10 : 30;
  TriangleMesh block = rectangleMesh({.lower = {-150, -150},
                                      .upper = {150, 0},
                                      .cellsX = blockCells + 1,
                                      .cellsY = blockCells / 4,
                                      .focus = Point(0, 0),
                                      .grading = {grading, grading}},
                                     Cut::both);
  Model model;
  model.bodies.emplace_back(
      "disc", std::move(disc), material(discYoung),
      Conditions{
          {{flat, 0, constant(0)}, {flat, 1, [](double, double, double t) { return -depth * t; }}}, {}, {}});
  model.bodies.emplace_back("block", std::move(block), material(young),
                            Conditions{{{bottom, 0, constant(0)}, {bottom, 1, constant(0)}}, {}, {}});
  const ContactSide above{0, arc};
  const ContactSide below{1, top};
  InterfaceOptions options;
  options.stiffness = discNonmortar ? discYoung / young : young / discYoung;
  Rows(coupling, stabilised).set(options, 1 / (discNonmortar ? young : discYoung));
  addInterface(model, {discNonmortar ? above : below, discNonmortar ? below : above, coupling}, options);
  const auto [state, report] = run(model, 1, 1);
  EXPECT_EQ(report.status, Status::converged) << report.reason;
  const ContactInterface& interface = model.interfaces[0];
  const Vector& p = state.contactForce[0];
  Vector f1 = Vector::Zero(model.bodies[interface.pair().nonmortar.body].dofs());
  Vector f2 = Vector::Zero(model.bodies[interface.pair().mortar.body].dofs());
  interface.subtractForces(p, f1, f2);
  double force = 0;
  double second = 0;  // moment: F b^2 / 4
  double last = 0;
  for (int i = 0; i < interface.rows(); ++i) {
    const int v = interface.nonmortarNodes()[i];
    const double x = model.bodies[interface.pair().nonmortar.body].mesh().vertices[v].x();
    second += p[i] * x * x;
    if (p[i] > 0) last = std::max(last, std::abs(x));
  }
  for (Eigen::Index dof = 1; dof < f1.size(); dof += 2) force += f1[dof];
  const Measured exact = hertz(std::abs(force), plane, young);
  const Vector pressure = interface.contactPressure(p);
  double worst = 0;
  for (int i = 0; i < interface.rows(); ++i) {
    const int v = interface.nonmortarNodes()[i];
    const double at = model.bodies[interface.pair().nonmortar.body].mesh().vertices[v].x() / exact.width;
    if (!(std::abs(at) < upTo)) continue;
    worst = std::max(worst, std::abs(pressure[i] / exact.peak / std::sqrt(1 - at * at) - 1));
  }
  return {pressure.maxCoeff() / exact.peak, 2 * std::sqrt(second / p.sum()) / exact.width, last / exact.width,
          worst, pressure.minCoeff() / exact.peak};
}

TEST(Hertz, discOnABlock) {
  constexpr double tolerance =
      0.015;  // b/R = 0.13: small strain and the parabola are off by about one hundredth
  constexpr double element = 0.08;  // the largest beside the edge, in half-widths
  EXPECT_NEAR(hertz(35000, Plane::stress).peak, 3420.22, 0.01);
  EXPECT_NEAR(hertz(35000, Plane::stress).width, 6.514700, 1e-6);
  for (const CouplingKind coupling : {CouplingKind::mortar, CouplingKind::interpolation})
    for (const bool discNonmortar : {true, false}) {
      std::cout << scenes::nameOf(coupling) << ", nonmortar " << (discNonmortar ? "disc " : "block")
                << ": peak and width over Hertz's";
      std::vector<Measured> found;
      for (const int cells : {8, 16, 32}) {
        found.push_back(solveHertz(cells, coupling, discNonmortar));
        std::cout << "  " << found.back().peak << ", " << found.back().width;
      }
      std::cout << "; last closed node " << found.back().last << ", worst pressure " << found.back().worst;
      // The limit is not quite Hertz's: the order is that of the changes.
      std::vector<double> h;
      std::vector<double> changes;
      for (size_t i = 1; i < found.size(); ++i) {
        h.push_back(std::pow(0.5, i));
        changes.push_back(std::abs(found[i].width - found[i - 1].width));
      }
      std::cout << "; order of the width " << fittedOrder(h, changes) << "\n";
      if (coupling == CouplingKind::interpolation) continue;
      EXPECT_NEAR(found.back().peak, 1, tolerance);
      EXPECT_NEAR(found.back().width, 1, tolerance);
      EXPECT_LE(found.back().worst, tolerance);
      // The edge is the width; nodes tell it to an element, the pressure beside it not at all: its slope is
      // infinite.
      EXPECT_NEAR(found.back().last, 1, element);
    }
}

// Nodal pressures where the nonmortar side is twice as fine: they alternate unless conditions are stabilised.
TEST(Hertz, finerAndStifferNonmortarSide) {
  constexpr double tolerance = 0.02;
  constexpr double width = 0.03;  // the block has 8 elements on the half-width
  for (const double block : {blockYoung, 1e-3 * discYoung}) {
    const auto solve = [&](CouplingKind kind, bool stabilise) {
      return solveHertz(32, kind, true, Plane::stress, block, 124, 0.55, stabilise);
    };
    const Measured all = solve(CouplingKind::weighted, false);
    std::cout << "E " << discYoung / block << " to 1: nodal pressures off by " << all.worst << "\n";
    for (const CouplingKind kind : {CouplingKind::mortar, CouplingKind::weighted}) {
      const Measured stabilised = solve(kind, true);
      std::cout << "  stabilised, " << scenes::nameOf(kind) << " " << stabilised.worst << "; half-width "
                << stabilised.width << "\n";
      EXPECT_LE(stabilised.worst, tolerance);
      EXPECT_NEAR(stabilised.width, 1, width);
    }
    EXPECT_GE(all.worst, 5 * tolerance);
  }
}

// The tangential motion of the surface of the disc counts most against a wall that has none.
TEST(Hertz, discOnAWall) {
  constexpr double tolerance = 0.015;
  for (const bool discNonmortar : {true, false}) {
    const Measured found =
        solveHertz(32, CouplingKind::mortar, discNonmortar, Plane::stress, 1e9 * discYoung);
    std::cout << "on a wall, nonmortar " << (discNonmortar ? "disc" : "wall")
              << ": peak, width and largest deviation " << found.peak << ", " << found.width << ", "
              << found.worst << "\n";
    EXPECT_NEAR(found.peak, 1, tolerance);
    EXPECT_NEAR(found.width, 1, tolerance);
    EXPECT_LE(found.worst, tolerance);
  }
}

TEST(Hertz, discOnABlockInPlaneStrain) {
  constexpr double tolerance = 0.015;
  EXPECT_NEAR(hertz(35000, Plane::strain).peak, 3585.36, 0.01);
  EXPECT_NEAR(hertz(35000, Plane::strain).width, 6.214628, 1e-6);
  for (const auto& [discNonmortar, cells] : {std::pair(true, 48), std::pair(false, 24)}) {
    const Measured found = solveHertz(cells, CouplingKind::mortar, discNonmortar, Plane::strain);
    std::cout << "plane strain, nonmortar " << (discNonmortar ? "disc " : "block")
              << ": peak and width over Hertz's  " << found.peak << ", " << found.width << "\n";
    EXPECT_NEAR(found.peak, 1, tolerance);
    EXPECT_NEAR(found.width, 1, tolerance);
  }
}

// ---- Receding contact: a layer of thickness 1 on a half plane under a line load, one half of it

struct Receding {
  double layerOverBase = 0;  ///< E1'/E2', 0 for a rigid base
  double width = 0;
  double peak = 0;  ///< p(0) over the load
};

/// Meshes are fine around the place x = `focus` of the interface.
Measured solveReceding(const Receding& scene, double load, double focus) {
  constexpr int cells = 24;
  constexpr double length = 6;
  constexpr double size = 100;
  constexpr double loadedWidth = 0.01;
  const bool rigid = scene.layerOverBase == 0;
  TriangleMesh layer = rectangleMesh({.lower = {0, 0},
                                      .upper = {length, 1},
                                      .cellsX = 5 * cells,
                                      .cellsY = cells,
                                      .focus = Point(focus, 0),
                                      .grading = {10, 4}},
                                     Cut::both);
  TriangleMesh base = rectangleMesh({.lower = {0, -size},
                                     .upper = {size, 0},
                                     .cellsX = 5 * cells,
                                     .cellsY = 4 * cells,
                                     .focus = Point(focus, 0),
                                     .grading = {2000, 2000}},
                                    Cut::both);
  const Function line = [=](double x, double, double) { return x < loadedWidth ? -load / loadedWidth : 0; };
  Model model;
  model.bodies.emplace_back("layer", std::move(layer), elasticMaterial({1, 0.3}),
                            Conditions{{{left, 0, constant(0)}}, {{top, 1, line}}, {}});
  Conditions held{{{bottom, 0, constant(0)}, {bottom, 1, constant(0)}, {left, 0, constant(0)}}, {}, {}};
  if (rigid) held.displacements = {{top, 0, constant(0)}, {top, 1, constant(0)}};
  model.bodies.emplace_back("base", std::move(base),
                            elasticMaterial({rigid ? 1 : 1 / scene.layerOverBase, 0.3}), std::move(held));
  addInterface(model, {{0, bottom}, {1, top}, CouplingKind::mortar});
  const auto [state, report] = run(model, 1, 1);
  EXPECT_EQ(report.status, Status::converged) << report.reason;
  const ContactInterface& interface = model.interfaces[0];
  const Vector pressure = interface.contactPressure(state.contactForce[0]);
  const double half = state.contactForce[0].sum();
  const auto x = [&](int i) { return model.bodies[0].mesh().vertices[interface.nonmortarNodes()[i]].x(); };
  int last = 0;
  for (int i = 0; i < interface.rows(); ++i)
    if (state.contactForce[0][i] > 0) last = i;
  // Near its end the pressure goes as the square root of the distance: the zero of its square through two
  // nodes.
  const int i = last - 2;
  const int j = last - 5;
  const double a = pressure[i] * pressure[i];
  const double b = pressure[j] * pressure[j];
  return {pressure[0] / (2 * half), x(i) + (x(i) - x(j)) * a / (b - a)};
}

TEST(Receding, layerOnAHalfPlane) {
  constexpr double tolerance = 0.01;
  constexpr double independence = 1e-10;
  for (const Receding& scene :
       {Receding{0, 0.856994, 0.960333}, Receding{1, 1.324165, 0.713081}, Receding{10, 2.68531, 0.36535}}) {
    const auto solve = [&](double load) {
      return Measured{solveReceding(scene, load, 0).peak, solveReceding(scene, load, scene.width).width};
    };
    const Measured found = solve(1);
    std::cout << "E1'/E2' " << scene.layerOverBase << ": half width " << found.width << " (exact "
              << scene.width << "), p(0)/P " << found.peak << " (" << scene.peak << ")\n";
    EXPECT_NEAR(found.width / scene.width, 1, tolerance);
    EXPECT_NEAR(found.peak / scene.peak, 1, tolerance);
    for (const double load : {1e-6, 1e5}) {
      const Measured other = solve(load);
      EXPECT_NEAR(other.width / found.width, 1, independence);
      EXPECT_NEAR(other.peak / found.peak, 1, independence);
    }
  }
}

}  // namespace mortier::exact_contact_test
