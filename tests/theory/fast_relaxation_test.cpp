// Steps chosen by their error where stresses relax within a small part of the run, or less.
#include <gtest/gtest.h>

#include <iostream>
#include <numbers>

#include "material/viscoelastic.h"
#include "theory/controlled_runs.h"
#include "theory/scenes.h"
#include "time/breaks.h"

namespace mortier::fast_relaxation_test {

using namespace scenes;

// ---- stresses that follow at once

/// Two blocks with lambda = 10 and a yield stress of 1, whose top moves.
Model movedBlocks(double young, const std::function<double(double)>& path, double overlap = 0) {
  const auto material = perzynaMaterial({young, 0.3}, {10, 1, Projection::frobenius});
  const Function moved = [path](double, double, double t) { return path(t); };
  Body upper("upper", square(0, 1), material, {{{left, 0, constant(0)}, {top, 1, moved}}, {}, {}});
  Body lower("lower", square(-1 + overlap, 2), material,
             {{{left, 0, constant(0)}, {bottom, 1, constant(0)}}, {}, {}});
  return contactModel(std::move(upper), std::move(lower), CouplingKind::mortar, upperBody);
}

double pressure(const State& state) {
  return -toCartesian(state.bodies[0].stress.col(0))[1];
}

// The stress relaxes 1500 times within the run: it is the viscosity times the rate, and the error of backward
// Euler that of half a step later. An estimate that takes what a steady course repeats for no error at all,
// or adds up what relaxes, is far off.
TEST(ErrorControl, backwardEulerKnowsItsErrorWhereStressesFollowAtOnce) {
  constexpr double end = 10;
  constexpr double tolerance = 5e-3;
  constexpr int fine = 5000;
  constexpr double settled = 0.1;  // the fine steps do not follow how the first stress builds up
  const auto path = [](double t) { return -(3 * t + std::sin(2 * std::numbers::pi * t / 5)); };
  const Model model = movedBlocks(3e3, path);
  State state = initialState(model);
  std::vector<double> exact{0};
  runWith(model, state, {.end = end, .steps = fine, .scheme = Scheme::sdirk2},
          [&](const State& now, const StepReport& report) {
            if (report.step > 0) exact.push_back(pressure(now));
          });
  ASSERT_EQ(exact.size(), fine + 1);
  const double largest = *std::max_element(exact.begin(), exact.end());
  double worst = 0;
  double errors = 0;  // sums of squares
  double estimates = 0;
  state = initialState(model);
  TimePlan plan = controlled(end, tolerance, Scheme::backwardEuler);
  plan.data = {resolve(path, 0, end)};
  const RunReport run = runWith(model, state, plan, [&](const State& now, const StepReport& report) {
    if (report.step == 0) worst = errors = estimates = 0;
    if (now.time < settled) return;
    const double at = now.time / end * fine;
    const int i = std::min(static_cast<int>(at), fine - 1);
    const double between = exact[i] + (at - i) * (exact[i + 1] - exact[i]);
    const double error = std::abs(pressure(now) - between) / largest;
    worst = std::max(worst, error);
    errors += error * error;
    estimates += report.estimate * report.estimate;
  });
  print("stress that follows at once", run);
  const double effectivity = std::sqrt(estimates / errors);
  std::cout << ", error " << worst << ", estimate over error " << effectivity << "\n";
  EXPECT_EQ(run.status, Status::converged) << run.reason;
  EXPECT_LE(worst, 1.5 * tolerance);
  EXPECT_GE(effectivity, 0.3);
  EXPECT_LE(effectivity, 3);
  EXPECT_LE(run.timeError, tolerance);
}

// ---- what acts in the first moment, and what time does not resolve

// An overlap presses the blocks by 9 yield stresses, which relax within 1e-10 of the run.
TEST(ErrorControl, anOverlapActsInTheFirstMoment) {
  constexpr double tolerance = 1e-3;
  const Model model = movedBlocks(
      3e11, [](double) { return 0; }, 6e-11);
  State state = initialState(model);
  double first = 0;
  int begun = 0;
  const RunReport run =
      runWith(model, state, controlled(1, tolerance), [&](const State& now, const StepReport& report) {
        if (report.step > 0) return;
        ++begun;
        first = pressure(now);
      });
  print("overlap", run);
  std::cout << ", estimate " << run.timeError << "\n";
  EXPECT_EQ(run.status, Status::converged) << run.reason;
  EXPECT_NEAR(first, 9, 1e-4);
  EXPECT_NEAR(pressure(state), 1, 9 * tolerance);
  EXPECT_LE(run.timeError, tolerance);
  EXPECT_LE(begun, 3);
  EXPECT_LE(run.steps, 300);
}

// The top jumps in the middle of the run, and the stress relaxes in less than doubles tell two times apart
// by.
TEST(ErrorControl, whatTimeDoesNotResolveIsNotTriedAgain) {
  constexpr double tolerance = 1e-3;
  const auto jump = [](double t) { return t < 0.5 ? 0.0 : -1e-12; };
  const Model model = movedBlocks(3e15, jump);
  State state = initialState(model);
  TimePlan plan = controlled(1, tolerance);
  plan.breaks = resolve(jump, 0, 1).breaks;
  int begun = 0;
  const RunReport run = runWith(
      model, state, plan, [&](const State&, const StepReport& report) { begun += report.step == 0 ? 1 : 0; });
  print("unresolved jump", run);
  std::cout << ", estimate " << run.timeError << "\n";
  EXPECT_EQ(run.status, Status::converged) << run.reason;
  EXPECT_GT(run.timeError, tolerance);  // which is reported
  EXPECT_NE(run.shortfall.find("above tolerance 0.001"), std::string::npos) << run.shortfall;
  EXPECT_EQ(begun, 1);
  EXPECT_LE(run.steps, 300);
}

// ---- stresses that have relaxed

// Loaded, then at rest for steps of 20 relaxation times each: stresses decay beyond the smallest numbers.
TEST(Relaxation, bodiesWithoutStressStayAtRest) {
  const Function moved = [](double, double, double t) { return -0.01 * std::min(t, 0.1); };
  for (const Plane plane : {Plane::stress, Plane::strain})
    for (const Scheme scheme : {Scheme::backwardEuler, Scheme::sdirk2}) {
      const auto material = viscoelasticMaterial({3e4, 0.3}, {1e-5, 0}, plane);
      const std::vector<Condition> above{{left, 0, constant(0)}, {top, 1, moved}};
      const std::vector<Condition> below{{left, 0, constant(0)}, {bottom, 1, constant(0)}};
      std::vector<Condition> both = below;
      both.push_back(above[1]);
      const auto block = [](double lowerY, int cells) {  // on crisscross meshes every number is the same
        return rectangleMesh(
            {.lower = {0, lowerY}, .upper = {1, lowerY + 1}, .cellsX = cells, .cellsY = cells});
      };
      std::vector<Model> models(1);
      models[0].bodies.emplace_back("block", block(0, 2), material, Conditions{both, {}, {}});
      for (const double friction : {0.0, 0.3}) {
        InterfaceOptions options;
        options.friction.coefficient = friction;
        models.push_back(contactModel({"upper", block(0, 1), material, {above, {}, {}}},
                                      {"lower", block(-1, 2), material, {below, {}, {}}},
                                      CouplingKind::interpolation, upperBody, options));
      }
      for (const Model& model : models) {
        State state = initialState(model);
        const RunReport run = runWith(model, state, {.end = 0.4, .steps = 2000, .scheme = scheme});
        EXPECT_EQ(run.status, Status::converged) << run.reason;
        EXPECT_LE(run.iterations, 4 * run.steps);
      }
    }
}

}  // namespace mortier::fast_relaxation_test
