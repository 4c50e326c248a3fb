// Friction beside flow: schemes, and bodies that friction alone holds.
#include <gtest/gtest.h>

#include <cmath>

#include "theory/scenes.h"

namespace mortier::friction_steps_test {

using namespace scenes;

constexpr double mu = 0.3;

InterfaceOptions hasFriction() {
  InterfaceOptions options;
  options.friction = {mu, 0};
  return options;
}

Body ground() {
  return {"lower",
          crissCrossMesh({.lower = {-0.3, -1}, .upper = {1.3, 0}, .cellsX = 9, .cellsY = 5}),
          elasticMaterial({40, 0.2}),
          {{{bottom, 0, constant(0)}, {bottom, 1, constant(0)}}, {}, {}}};
}

/// A low block under a pressure of 2 and this shear stress on its top.
Result pushed(CouplingKind coupling, int nonmortarBody, double shear, double stiffness) {
  Body block(
      "upper", crissCrossMesh({.lower = {0, 0}, .upper = {1, 0.4}, .cellsX = 5, .cellsY = 2}),
      elasticMaterial({stiffness, 0.3}),
      {{}, {{top, 0, [=](double, double, double t) { return shear * t; }}, {top, 1, constant(-2)}}, {}});
  const Model model = contactModel(std::move(block), ground(), coupling, nonmortarBody, hasFriction());
  return run(model, 1, 3);
}

// Up to mu p friction holds a block that nothing else holds; beyond it slides, and that is said.
TEST(FrictionAlone, holdsUpToItsBound) {
  for (const CouplingKind coupling :
       {CouplingKind::mortar, CouplingKind::interpolation, CouplingKind::weighted})
    for (const int nonmortar : {upperBody, lowerBody})
      for (const double stiffness : {100.0, 1e9}) {
        const Result held = pushed(coupling, nonmortar, mu * 2 * (1 - 1e-6), stiffness);
        ASSERT_EQ(held.report.status, Status::converged) << held.report.reason;
        const double along = nonmortar == upperBody ? 1 : -1;  // the tangent is turned with the normal
        EXPECT_NEAR(std::abs(held.state.frictionForce[0].sum()), mu * 2 * (1 - 1e-6), 1e-10) << along;
        EXPECT_NEAR(held.state.contactForce[0].sum(), 2, 1e-10);
        EXPECT_LE(held.report.worst.friction, 1e-12);
        const Result slides = pushed(coupling, nonmortar, mu * 2 * (1 + 1e-6), stiffness);
        EXPECT_EQ(slides.report.status, Status::unheld);
        EXPECT_EQ(slides.report.steps, 2);
        EXPECT_NE(slides.report.reason.find("body upper: translation along (1, 0)"), std::string::npos)
            << slides.report.reason;
      }
}

/// Blocks that flow, sheared while they are pressed; the friction work at the end.
double workOf(Scheme scheme, int steps) {
  const auto along = [](double, double, double t) { return 0.05 * t * t; };
  const auto down = [](double, double, double t) { return -0.06 * t; };
  Body upper("upper", square(0, 5), perzynaMaterial({100, 0.3}, {1, 1, Projection::frobenius}),
             {{{top, 0, along}, {top, 1, down}}, {}, {}});
  const Model model =
      contactModel(std::move(upper), ground(), CouplingKind::mortar, upperBody, hasFriction());
  State state = initialState(model);
  const RunReport report = march(model, state, {.end = 1, .steps = steps, .scheme = scheme}, {},
                                 [](const State&, const StepReport&) {});
  EXPECT_EQ(report.status, Status::converged) << report.reason;
  return state.frictionWork;
}

// All schemes tend to one motion; the slip of a step makes friction of first order in each.
TEST(FrictionBesideFlow, schemesTendToOneAnswer) {
  const double finest = workOf(Scheme::sdirk2, 320);
  EXPECT_GT(finest, 0);
  for (const Scheme scheme : {Scheme::backwardEuler, Scheme::sdirk2, Scheme::crankNicolson}) {
    const double coarse = std::abs(workOf(scheme, 20) - finest);
    const double fine = std::abs(workOf(scheme, 80) - finest);
    std::cout << "work " << finest << ", off by " << coarse << " in 20 steps, " << fine << " in 80\n";
    EXPECT_LT(fine, coarse / 2.5);
    EXPECT_LT(fine, 0.03 * finest);
  }
}

}  // namespace mortier::friction_steps_test
