// Steps chosen by their error where there is friction.
#include <gtest/gtest.h>

#include <cmath>
#include <iostream>

#include "theory/controlled_runs.h"
#include "theory/scenes.h"

namespace mortier {
namespace {

using namespace scenes;

constexpr double mu = 0.2;

/// A rigid parabola that is pressed into a block: where it sticks and where it slips grows with the contact
/// (Spence 1975).
Model roughPunch(double motion) {
  Body block("block",
             rectangleMesh({.lower = {-4, -4},
                            .upper = {4, 0},
                            .cellsX = 60,
                            .cellsY = 24,
                            .focus = Point(0, 0),
                            .grading = {20, 20}}),
             elasticMaterial({100, 0.2}), {{{bottom, 0, constant(0)}, {bottom, 1, constant(0)}}, {}, {}});
  const auto down = [=](double, double, double t) { return -motion * t; };
  Body punch("punch", rectangleMesh({.lower = {-2, 0}, .upper = {2, 1}, .cellsX = 2, .cellsY = 1}),
             elasticMaterial({100, 0.2}), {{{bottom, 0, constant(0)}, {bottom, 1, down}}, {}, {}});
  InterfaceOptions options;
  options.friction = {mu, 0};
  options.gap = [](const Point& x) { return x.x() * x.x() / 2; };
  return contactModel(std::move(punch), std::move(block), CouplingKind::mortar, lowerBody, options);
}

int stuck(const State& state) {
  int nodes = 0;
  for (Eigen::Index i = 0; i < state.contactForce[0].size(); ++i)
    nodes += state.contactForce[0][i] > 0 && state.slipping[0][i] == 0 ? 1 : 0;
  return nodes;
}

// One step is off by far, and no stage of it shows that; pairs of steps do.
TEST(SlipControl, findsTheStepsOfARoughPunch) {
  const Model model = roughPunch(0.3);
  const Result once = run(model, 1, 1);
  const Result fine = run(model, 1, 600);
  ASSERT_EQ(fine.report.status, Status::converged) << fine.report.reason;
  const double exact = fine.state.frictionWork;
  EXPECT_GT(once.state.frictionWork, 5 * exact);
  EXPECT_LT(stuck(once.state), 0.7 * stuck(fine.state));
  double coarser = 0;
  for (const double tolerance : {0.2, 0.05}) {
    for (const Scheme scheme : {Scheme::backwardEuler, Scheme::sdirk2}) {
      State state = initialState(model);
      const RunReport report = runWith(model, state, controlled(1, tolerance, scheme));
      ASSERT_EQ(report.status, Status::converged) << report.reason;
      const double error = std::abs(state.frictionWork / exact - 1);
      print("tolerance " + std::to_string(tolerance), report);
      std::cout << ", dissipation off by " << error << ", estimate " << report.timeError << ", stuck "
                << stuck(state) << " of " << stuck(fine.state) << " nodes\n";
      EXPECT_LE(error, tolerance);
      EXPECT_LE(report.timeError, tolerance);
      EXPECT_GT(report.timeError, error / 2);
      EXPECT_LE(std::abs(stuck(state) - stuck(fine.state)), 2);
      if (scheme == Scheme::backwardEuler) {
        EXPECT_GT(report.steps, coarser);
        coarser = report.steps;
      }
    }
  }
}

}  // namespace
}  // namespace mortier
