// A pin in a hole, meshed as polygons that do not match: the distance is that of the circles, not of the
// polygons.
#include <gtest/gtest.h>

#include <cmath>
#include <iostream>

#include "theory/scenes.h"

namespace mortier::fits_test {

using namespace scenes;

constexpr int innerCircle = 1;
constexpr int outerCircle = 2;
constexpr Elasticity steel{2.1e5, 0.3};

/// The upper half of a pin of radius 10 that touches a hole of radius 10.05 on top is moved up.
Vector pinInHole(int pinEdges, int holeEdges, bool pinNonmortar, bool given) {
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
  return model.interfaces[0].contactPressure(state.contactForce[0]);
}

TEST(PinInAHole, pressuresAreThoseOfTheDistanceOfTheCircles) {
  for (const bool pinNonmortar : {true, false})
    for (const auto& [pin, hole] : {std::pair(24, 19), std::pair(48, 41), std::pair(96, 77)}) {
      const Vector found = pinInHole(pin, hole, pinNonmortar, false);
      const Vector exact = pinInHole(pin, hole, pinNonmortar, true);
      const double peak = exact.maxCoeff();
      double worst = 0;
      for (Eigen::Index i = 0; i < exact.size(); ++i)
        worst = std::max(worst, std::abs(found[i] - exact[i]) / peak);
      std::cout << "nonmortar " << (pinNonmortar ? "pin " : "hole") << ", " << pin << " on " << hole
                << " edges: largest pressure " << found.maxCoeff() << ", with the distance given " << peak
                << ", largest difference over that " << worst << "\n";
      EXPECT_NEAR(found.maxCoeff() / peak, 1, 0.02);
      EXPECT_LE(worst, 0.02);
    }
}

}  // namespace mortier::fits_test
