// Steps chosen by their error where there is friction.
#include <gtest/gtest.h>

#include <cmath>
#include <iostream>

#include "theory/controlled_runs.h"
#include "theory/scenes.h"
#include "time/quantity.h"

namespace mortier::slip_control_test {

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
  options.gap = still([](const Point& x) { return x.x() * x.x() / 2; });
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
  EXPECT_GT(once.state.frictionWork, 3 * exact);
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

/// Pressed, sheared, let go.
double down(double t) {
  return -0.05 * (t <= 1 ? t : t <= 2 ? 1 : 3 - t);
}
double along(double t) {
  return 0.04 * (t <= 1 ? 0 : t <= 2 ? t - 1 : 1);
}

double inner(const Body& body, const Matrix& stress, const Matrix& strain) {
  double sum = 0;
  for (int i = 0; i < body.points(); ++i) sum += body.weights()[i] * stress.col(i).dot(strain.col(i));
  return sum;
}

// Whatever the lengths of the steps: the plate's work is the change of the elastic energy, what flow and
// friction dissipate, and what gaps take that close or open.
TEST(SlipControl, keepsTheEnergy) {
  Body upper("upper", square(0, 5), perzynaMaterial({100, 0.3}, {1, 1, Projection::frobenius}),
             {{{top, 0, [](double, double, double t) { return along(t); }},
               {top, 1, [](double, double, double t) { return down(t); }}},
              {},
              {}});
  Body lower("lower", crissCrossMesh({.lower = {-0.3, -1}, .upper = {1.3, 0}, .cellsX = 9, .cellsY = 5}),
             elasticMaterial({40, 0.2}), {{{bottom, 0, constant(0)}, {bottom, 1, constant(0)}}, {}, {}});
  InterfaceOptions options;
  options.friction = {0.3, 0};
  const Model model =
      contactModel(std::move(upper), std::move(lower), CouplingKind::mortar, upperBody, options);
  State before = initialState(model);
  State state = before;
  double worst = 0;
  double largest = 0;
  double flowed = 0;
  TimePlan plan = controlled(3, 0.05, Scheme::backwardEuler);
  plan.breaks = {1, 2};
  plan.quantities = externalWorks();
  const RunReport report = runWith(model, state, plan, [&](const State& now, const StepReport& step) {
    if (step.step == 0) {
      before = now;
      return;
    }
    double left = workSince(before, now) - (now.frictionWork - before.frictionWork);
    double energy = 0;
    for (size_t b = 0; b < now.bodies.size(); ++b) {
      const Body& body = model.bodies[b];
      const Matrix mean = (before.bodies[b].stress + now.bodies[b].stress) / 2;
      Matrix elastic;
      body.material().elasticStrain(now.bodies[b].stress - before.bodies[b].stress, elastic);
      left -= inner(body, mean, elastic);
      if (!body.material().linear()) {
        const double flow =
            inner(body, mean, now.bodies[b].viscoplasticStrain - before.bodies[b].viscoplasticStrain);
        left -= flow;
        flowed += flow;
      }
      body.material().elasticStrain(now.bodies[b].stress, elastic);
      energy += inner(body, now.bodies[b].stress, elastic) / 2;
    }
    largest = std::max(largest, energy);
    worst = std::max(worst, std::abs(left));
    before = now;
  });
  ASSERT_EQ(report.status, Status::converged) << report.reason;
  print("pressed, sheared, let go", report);
  std::cout << ", balance off by " << worst / largest << ", friction " << state.frictionWork / largest
            << " of the largest energy\n";
  EXPECT_LE(worst, 1e-11 * largest);
  EXPECT_LE(report.timeError, 0.05);
  EXPECT_GT(state.frictionWork, 0.01 * largest);
  EXPECT_GT(flowed, 0.01 * largest);
}

// What sticks until the contact opens slips just before that, and loses what shear has stored. Steps that
// pass from sticking to open contact end without a force. Contact opens within a step: at the end of one,
// rounding would decide.
TEST(SlipControl, seesWhatFrictionDissipatesAsContactOpens) {
  const auto lifted = [](double t) { return t <= 2 ? down(t) : -0.05 + 0.12 * (t - 2); };
  Body upper("upper", square(0, 3), elasticMaterial({100, 0.3}),
             {{{top, 0, [](double, double, double t) { return along(t); }},
               {top, 1, [=](double, double, double t) { return lifted(t); }}},
              {},
              {}});
  Body lower("lower", square(-1, 4), elasticMaterial({100, 0.3}),
             {{{bottom, 0, constant(0)}, {bottom, 1, constant(0)}}, {}, {}});
  InterfaceOptions options;
  options.friction = {0.8, 0};
  const Model model =
      contactModel(std::move(upper), std::move(lower), CouplingKind::mortar, upperBody, options);
  const Result fine = run(model, 3, 3000);
  ASSERT_EQ(fine.report.status, Status::converged) << fine.report.reason;
  const double exact = fine.state.frictionWork;
  for (const double tolerance : {0.1, 0.02}) {
    State state = initialState(model);
    TimePlan plan = controlled(3, tolerance, Scheme::backwardEuler);
    plan.breaks = {1, 2};
    const RunReport report = runWith(model, state, plan);
    ASSERT_EQ(report.status, Status::converged) << report.reason;
    const double error = std::abs(state.frictionWork / exact - 1);
    print("lifted, tolerance " + std::to_string(tolerance), report);
    std::cout << ", dissipation " << exact << " off by " << error << ", estimate " << report.timeError
              << "\n";
    EXPECT_LE(error, 1.5 * tolerance);
    EXPECT_LE(report.timeError, tolerance);
  }
}

}  // namespace mortier::slip_control_test
