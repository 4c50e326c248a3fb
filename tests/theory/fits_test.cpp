// Bodies that fit into each other, meshed as polygons that do not match: the distance is that of the circles,
// not of the polygons. Shrink fit after Lame; a pin in a hole with the distance of the circles as a
// reference.
#include <gtest/gtest.h>

#include <cmath>
#include <iostream>

#include "theory/scenes.h"

namespace mortier::fits_test {

using namespace scenes;

constexpr int innerCircle = 1;
constexpr int outerCircle = 2;
constexpr int onX = 3;
constexpr int onY = 4;
constexpr Elasticity steel{2.1e5, 0.3};

struct Pressures {
  std::vector<Point> places;
  Vector p;
};

Pressures pressuresOf(const Model& model, const State& state) {
  const ContactInterface& interface = model.interfaces[0];
  Pressures result{{}, interface.contactPressure(state.contactForce[0])};
  for (const int v : interface.nonmortarNodes())
    result.places.push_back(model.bodies[interface.pair().nonmortar.body].mesh().vertices[v]);
  return result;
}

/// A quarter of a ring of radii 10 and 20.05 in one of radii 20 and 40.
Pressures shrinkFit(int shaftEdges, int hubEdges, CouplingKind coupling, bool shaftNonmortar) {
  const Conditions symmetry{{{onX, 1, constant(0)}, {onY, 0, constant(0)}}, {}, {}};
  Model model;
  model.bodies.emplace_back(
      "shaft",
      annulusMesh({.inner = 10, .outer = 20.05, .quarters = 1, .cellsAround = shaftEdges, .cellsAcross = 14},
                  Cut::both),
      elasticMaterial(steel), symmetry);
  model.bodies.emplace_back(
      "hub",
      annulusMesh({.inner = 20, .outer = 40, .quarters = 1, .cellsAround = hubEdges, .cellsAcross = 11},
                  Cut::both),
      elasticMaterial(steel), symmetry);
  const ContactSide shaft{0, outerCircle};
  const ContactSide hub{1, innerCircle};
  addInterface(model, {shaftNonmortar ? shaft : hub, shaftNonmortar ? hub : shaft, coupling});
  EXPECT_EQ(model.interfaces[0].sagitta(), 0);
  EXPECT_LE((model.interfaces[0].initialDistance().array() + 0.05).abs().maxCoeff(), 1e-12);
  const auto [state, report] = run(model, 1, 1);
  EXPECT_EQ(report.status, Status::converged) << report.reason;
  return pressuresOf(model, state);
}

// delta = p b [ ((c^2 + b^2)/(c^2 - b^2) + nu)/E + ((b^2 + a^2)/(b^2 - a^2) - nu)/E ]
TEST(ShrinkFit, everyNodalPressureIsLames) {
  const double a2 = 100;
  const double b2 = 400;
  const double c2 = 1600;
  const double lame = 0.05 * steel.young / 20 / ((c2 + b2) / (c2 - b2) + (b2 + a2) / (b2 - a2));
  for (const CouplingKind coupling : couplings)
    for (const bool shaftNonmortar : {true, false})
      for (const auto& [shaft, hub] : {std::pair(33, 26), std::pair(66, 52)}) {
        Range range;
        for (const double p : shrinkFit(shaft, hub, coupling, shaftNonmortar).p) range.add(p / lame);
        std::cout << nameOf(coupling) << ", nonmortar " << (shaftNonmortar ? "shaft" : "hub  ") << ", "
                  << shaft << " on " << hub << " edges: pressure over Lame's " << range.min << " to "
                  << range.max << "\n";
        if (coupling == CouplingKind::mortar) {
          EXPECT_LE(range.distance(1), 0.02);
        }
      }
}

/// The upper half of a pin of radius 10 that touches a hole of radius 10.05 on top is moved up.
Pressures pinInHole(int pinEdges, int holeEdges, bool pinNonmortar, bool given) {
  constexpr double r = 10;
  constexpr double R = 10.05;
  const Point centre(0, R - r);
  Model model;
  model.bodies.emplace_back("pin",
                            annulusMesh({.centre = centre,
                                         .inner = 5,
                                         .outer = r,
                                         .quarters = 2,
                                         .cellsAround = pinEdges,
                                         .cellsAcross = 10},
                                        Cut::both),
                            elasticMaterial(steel),
                            Conditions{{{innerCircle, 0, constant(0)},
                                        {innerCircle, 1, [](double, double, double t) { return 0.05 * t; }}},
                                       {},
                                       {}});
  model.bodies.emplace_back(
      "plate",
      annulusMesh({.inner = R, .outer = 30, .quarters = 2, .cellsAround = holeEdges, .cellsAcross = 14},
                  Cut::both),
      elasticMaterial(steel),
      Conditions{{{outerCircle, 0, constant(0)}, {outerCircle, 1, constant(0)}}, {}, {}});
  const ContactSide pin{0, outerCircle};
  const ContactSide hole{1, innerCircle};
  InterfaceOptions options;
  if (given)  // from a node along the radius of its circle to the other one
    options.gap = still([=](const Point& x) {
      const Point from = pinNonmortar ? Point::Zero() : centre;  // of the other circle
      const double other = pinNonmortar ? R : r;
      const Point n = pinNonmortar ? Point((x - centre).normalized()) : Point(-x.normalized());
      const double along = (x - from).dot(n);
      const double root = std::sqrt(along * along - (x - from).squaredNorm() + other * other);
      return pinNonmortar ? root - along : -along - root;
    });
  addInterface(model, {pinNonmortar ? pin : hole, pinNonmortar ? hole : pin, CouplingKind::mortar}, options);
  const auto [state, report] = run(model, 1, 1);
  EXPECT_EQ(report.status, Status::converged) << report.reason;
  return pressuresOf(model, state);
}

TEST(PinInAHole, pressuresAreThoseOfTheDistanceOfTheCircles) {
  for (const bool pinNonmortar : {true, false})
    for (const auto& [pin, hole] : {std::pair(24, 19), std::pair(48, 41), std::pair(96, 77)}) {
      const Pressures found = pinInHole(pin, hole, pinNonmortar, false);
      const Pressures exact = pinInHole(pin, hole, pinNonmortar, true);
      const double peak = exact.p.maxCoeff();
      double worst = 0;
      for (Eigen::Index i = 0; i < exact.p.size(); ++i)
        worst = std::max(worst, std::abs(found.p[i] - exact.p[i]) / peak);
      std::cout << "nonmortar " << (pinNonmortar ? "pin " : "hole") << ", " << pin << " on " << hole
                << " edges: largest pressure " << found.p.maxCoeff() << ", with the distance given " << peak
                << ", largest difference over that " << worst << "\n";
      EXPECT_NEAR(found.p.maxCoeff() / peak, 1, 0.02);
      EXPECT_LE(worst, 0.02);
    }
}

}  // namespace mortier::fits_test
