// Friction of thin and of stiff bodies, whose compliances are far apart.
#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

#include "material/elasticity.h"
#include "theory/scenes.h"

namespace mortier::thin_friction_test {

using namespace scenes;

InterfaceOptions rough(double mu) {
  InterfaceOptions options;
  options.friction = {mu, 0};
  return options;
}

/// A belt half round a drum of radius 1, drawn at one end and loaded by 1 at the other.
Result capstan(double mu, double young, double thickness, CouplingKind coupling, bool swap, double end = 1,
               int steps = 3) {
  constexpr int drumBody = 1;
  constexpr int inside = 1;
  constexpr int outside = 2;
  const auto half = [](double inner, double outer, int layers) {
    return annulusMesh(
        {.inner = inner, .outer = outer, .quarters = 2, .cellsAround = 96, .cellsAcross = layers}, Cut::both);
  };
  Model model;
  model.bodies.emplace_back("belt", half(1, 1 + thickness, 2), elasticMaterial({1e5, 0}),
                            Conditions{{{left, 1, [](double, double, double t) { return -0.3 * t; }}},
                                       {{top, 1, constant(-1 / thickness)}},
                                       {}});
  model.bodies.emplace_back("drum", half(0.8, 1, 3), elasticMaterial({young, 0}),
                            Conditions{{{inside, 0, constant(0)}, {inside, 1, constant(0)}}, {}, {}});
  const ContactSide belt{0, inside};
  const ContactSide drum{drumBody, outside};
  addInterface(model, {swap ? drum : belt, swap ? belt : drum, coupling}, rough(mu));
  return run(model, end, steps);
}

// Euler 1769, Eytelwein 1808: the tensions at the ends of a belt that slips differ by exp(mu pi).
TEST(ThinFriction, beltsOnStiffDrumsSlip) {
  for (const double mu : {0.3, 1.0})
    for (const double young : {1e5, 1e8, 1e11})
      for (const double thickness : {0.002, 0.01}) {
        const Result result = capstan(mu, young, thickness, CouplingKind::mortar, false);
        ASSERT_EQ(result.report.status, Status::converged)
            << result.report.reason << ", mu " << mu << ", E " << young << ", thickness " << thickness;
        const double exact = std::exp(mu * std::numbers::pi) - 1;
        const double grip = std::abs(result.state.frictionForce[0].sum());
        // Its bending stiffness keeps the belt off the drum over the lengths (EI/T)^1/2 at its ends; it is
        // loaded at half its thickness.
        const double bending = 1e5 * std::pow(thickness, 3) / 12;
        const double off = std::sqrt(bending) * (1 + 1 / std::sqrt(1 + exact));
        EXPECT_LE(grip, (1.001 + thickness) * exact)
            << "mu " << mu << ", E " << young << ", thickness " << thickness;
        EXPECT_GE(grip, (1 - 1.2 * mu * off - 0.005) * exact)
            << "mu " << mu << ", E " << young << ", thickness " << thickness;
      }
}

// Zones of slip begin at the ends.
TEST(ThinFriction, beltsAreDrawnInShortSteps) {
  for (const double mu : {0.3, 1.0, 2.0})
    for (const double young : {1e7, 1e8})
      for (const double thickness : {0.002, 0.005}) {
        const Result result = capstan(mu, young, thickness, CouplingKind::mortar, false, 2 / 60.0, 2);
        EXPECT_EQ(result.report.status, Status::converged)
            << result.report.reason << ", mu " << mu << ", E " << young << ", thickness " << thickness;
      }
}

TEST(ThinFriction, anyCouplingAndSideIsSolved) {
  for (const CouplingKind coupling :
       {CouplingKind::mortar, CouplingKind::interpolation, CouplingKind::weighted})
    for (const bool swap : {false, true}) {
      const Result result = capstan(0.3, 1e8, 0.002, coupling, swap);
      EXPECT_EQ(result.report.status, Status::converged)
          << result.report.reason << ", " << nameOf(coupling) << ", swap " << swap;
    }
}

// A thin plate, finer than the block beneath it and up to a million times as stiff, held along its left side
// and by contact: pressed, then drawn off by its right end.
TEST(ThinFriction, stiffPlatesOnSoftBlocksAreSolved) {
  for (const double young : {1e6, 1e8, 1e9})
    for (const double mu : {0.01, 0.1, 1.0}) {
      Body plate("upper",
                 crissCrossMesh({.lower = {-0.8, 0}, .upper = {0.9, 0.02}, .cellsX = 80, .cellsY = 2}),
                 elasticMaterial({young, 0.3}),
                 {{{left, 0, constant(0)}},
                  {{top, 1, [](double, double, double t) { return -std::min(2 * t, 1.0); }},
                   {right, 0, [](double, double, double t) { return 10.2 * std::max(0.0, t - 0.5); }},
                   {right, 1, [](double, double, double t) { return 2.5 * std::max(0.0, t - 0.5); }}},
                  {}});
      Body block("lower", crissCrossMesh({.lower = {-1, -1}, .upper = {1, 0}, .cellsX = 48, .cellsY = 8}),
                 elasticMaterial({1000, 0.3}),
                 {{{bottom, 0, constant(0)}, {bottom, 1, constant(0)}}, {}, {}});
      const Model model =
          contactModel(std::move(plate), std::move(block), CouplingKind::mortar, upperBody, rough(mu));
      const Result result = run(model, 1, 4);
      ASSERT_EQ(result.report.status, Status::converged)
          << result.report.reason << ", mu " << mu << ", E " << young;
      // The pull upwards on the right side, a height of 0.02, is all that lessens the load of 1.7.
      EXPECT_NEAR(result.state.contactForce[0].sum(), 1.7 - 1.25 * 0.02, 1e-8);
    }
}

}  // namespace mortier::thin_friction_test
