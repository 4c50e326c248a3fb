// A march whose steps are chosen by their error: how it goes on from a checkpoint, ends when it has no steps
// left, judges a step that the guard does again, and finds a first step.
#include <gtest/gtest.h>

#include "theory/controlled_runs.h"
#include "theory/scenes.h"
#include "theory/time_cases.h"
#include "time/breaks.h"

namespace mortier::controlled_march_test {

using namespace scenes;

// A march that goes on from state and memory takes the steps that an uninterrupted one takes, bit for bit.
TEST(ControlledMarch, goesOnFromItsMemory) {
  const Model model = compression(2, 3, perzynaMaterial(noteElasticity, noteLaw(Projection::elasticity)),
                                  CouplingKind::interpolation, upperBody);
  const TimePlan plan = controlled(1, 1e-4);
  State whole = initialState(model);
  std::vector<std::pair<State, MarchMemory>> stops;
  MarchMemory memory;
  const RunReport run =
      march(model, whole, memory, plan, {}, [&](const State& state, const StepReport& report) {
        if (report.step == 0) stops.clear();
        if (report.step % 4 == 2) stops.emplace_back(state, memory);
      });
  ASSERT_EQ(run.status, Status::converged);
  ASSERT_GE(stops.size(), 2);
  for (auto& [state, at] : stops) {
    const RunReport rest = march(model, state, at, plan, {}, [](const State&, const StepReport&) {});
    EXPECT_EQ(rest.steps, run.steps);
    EXPECT_EQ(rest.iterations, run.iterations);
    for (size_t b = 0; b < state.bodies.size(); ++b) {
      EXPECT_TRUE(state.bodies[b].stress == whole.bodies[b].stress);
      EXPECT_TRUE(state.bodies[b].displacement == whole.bodies[b].displacement);
    }
  }
}

// Also from a run that is left, as its error is too large, and begun again.
TEST(ControlledMarch, goesOnFromARunThatIsBegunAgain) {
  for (const timecases::Case& each : timecases::cases(timecases::Size::small)) {
    if (each.name != "3 waves, hard, mortar, sdirk2") continue;
    const Model model = each.model();
    const TimePlan plan = each.plan(each.scheme, 1e-3);
    State whole = initialState(model);
    std::vector<std::pair<State, MarchMemory>> stops;
    MarchMemory memory;
    const RunReport run =
        march(model, whole, memory, plan, {}, [&](const State& state, const StepReport& report) {
          if (report.step == 0 || report.step % 10 == 3) stops.emplace_back(state, memory);
        });
    ASSERT_EQ(run.status, Status::converged);
    EXPECT_LE(run.timeError, plan.tolerance);
    ASSERT_GT(memory.controller.trial, 1);
    EXPECT_EQ(stops.front().second.controller.trial, 1);
    for (auto& [state, at] : stops) {
      const RunReport rest = march(model, state, at, plan, {}, [](const State&, const StepReport&) {});
      EXPECT_EQ(rest.steps, run.steps);
      EXPECT_EQ(rest.iterations, run.iterations);
      EXPECT_EQ(at.controller.trial, memory.controller.trial);
      for (size_t b = 0; b < state.bodies.size(); ++b)
        EXPECT_TRUE(state.bodies[b].stress == whole.bodies[b].stress);
    }
  }
}

TEST(ControlledMarch, tooFewStepsEndTheRunWithTheLastGoodState) {
  const Model model = compression(2, 3, perzynaMaterial(noteElasticity, noteLaw(Projection::elasticity)),
                                  CouplingKind::mortar, upperBody);
  State state = initialState(model);
  TimePlan plan = controlled(1, 1e-6);
  plan.maxSteps = 7;
  double last = 0;
  const RunReport run =
      runWith(model, state, plan, [&](const State& now, const StepReport&) { last = now.time; });
  EXPECT_EQ(run.status, Status::failed);
  EXPECT_NE(run.reason.find("max_steps = 7"), std::string::npos) << run.reason;
  EXPECT_EQ(run.steps + run.rejected, 7);
  EXPECT_EQ(state.time, last);
  EXPECT_GT(last, 0);
}

// ---- guard

/// A square whose outline is held, under twice the yield stress in both directions: s = 1 + exp(-rate t).
struct Held {
  double rate;
  Model model;
  State state;

  explicit Held(double relaxation) : rate(relaxation) {
    Conditions held;
    for (const int side : {bottom, right, top, left})
      for (const int component : {0, 1}) held.displacements.push_back({side, component, constant(0)});
    model.bodies.emplace_back("square", square(0, 2),
                              perzynaMaterial({2 * rate * (1 - 0.3), 0.3}, {1, 1, Projection::frobenius}),
                              held);
    state = initialState(model);
    state.bodies[0].stress.colwise() = fromCartesian(Eigen::Vector3d(2, 2, 0));
  }
  [[nodiscard]] double stress() const { return toCartesian(state.bodies[0].stress.col(0))[0]; }
};

// A step that is too long overshoots, the guard does it again with backward Euler, and that error is of the
// first order: taken for one of the third it would be let through.
TEST(ControlledMarch, aGuardedStepIsJudgedByItsOwnError) {
  constexpr double tolerance = 1e-3;
  for (const double rate : {2.0, 20.0, 200.0}) {
    Held held(rate);
    TimePlan plan = controlled(1, tolerance);
    plan.steps = 1;
    double worst = 0;
    const RunReport run =
        runWith(held.model, held.state, plan, [&](const State& now, const StepReport& report) {
          if (report.step == 0) worst = 0;
          if (report.step == 0) return;
          const double s = toCartesian(now.bodies[0].stress.col(0))[0];
          worst = std::max(worst, std::abs(s - 1 - std::exp(-rate * now.time)));
        });
    ASSERT_EQ(run.status, Status::converged) << run.reason;
    print("relaxation, rate " + std::to_string(rate), run);
    std::cout << ", worst error of the stress " << worst << "\n";
    EXPECT_LT(worst, 6 * tolerance);  // of 2, at any step; local errors of one sign add up
  }
}

// Ramp, then hold, theta e = 1e8: the stress is the yield stress and a little of the order of 1e-8.
TEST(ControlledMarch, stiffRampAndHold) {
  constexpr double lambda = 1;
  constexpr double young = 2e8;
  const auto path = [](double t) { return -1e-3 * std::min(t, 1.0); };
  const Function moved = [path](double, double, double t) { return path(t); };
  const auto worstError = [&](const TimePlan& plan) {
    const auto material = perzynaMaterial({young, 0.3}, {lambda, 1, Projection::frobenius});
    Body upper("upper", square(0, 3), material, {{{left, 0, constant(0)}, {top, 1, moved}}, {}, {}});
    Body lower("lower", square(-1, 4), material,
               {{{left, 0, constant(0)}, {bottom, 1, constant(0)}}, {}, {}});
    const Model model = contactModel(std::move(upper), std::move(lower), CouplingKind::mortar, upperBody);
    State state = initialState(model);
    double worst = 0;
    const RunReport run = runWith(model, state, plan, [&](const State& now, const StepReport& report) {
      if (report.step == 0) worst = 0;
      if (now.time <= 1) return;
      for (const BodyState& body : now.bodies)
        for (Eigen::Index i = 0; i < body.stress.cols(); ++i)
          worst = std::max(worst, std::abs(vonMises(body.stress.col(i)) - 1));
    });
    EXPECT_EQ(run.status, Status::converged) << run.reason;
    EXPECT_EQ(count(run, "cut"), 0);
    print("stiff hold", run);
    std::cout << ", error " << worst << "\n";
    return worst;
  };
  const double euler = worstError({.end = 2, .steps = 20});
  const double equal = worstError({.end = 2, .steps = 20, .scheme = Scheme::sdirk2});
  TimePlan plan = controlled(2, 1e-4);
  plan.breaks = resolve(path, 0, 2).breaks;
  const double chosen = worstError(plan);
  constexpr double rounding = 1e-9;
  EXPECT_LT(euler, 1e-7);
  EXPECT_LE(equal, euler + rounding);
  EXPECT_LE(chosen, euler + rounding);
}

// ---- the pilot

// Bodies pass yield triangle by triangle in its first step, which is not what it is for.
TEST(ControlledMarch, aPilotThatPassesYieldIsCheap) {
  struct PilotIsDone {};
  for (const timecases::Case& each : timecases::cases(timecases::Size::small)) {
    if (each.name != "sine, hard, interpolation, sdirk2" &&
        each.name != "3 waves, hard, interpolation, sdirk2")
      continue;
    const Model model = each.model();
    const TimePlan plan = each.plan(each.scheme, 1e-2);
    State state = initialState(model);
    MarchMemory memory;
    const Observer stop = [](const State&, const StepReport&) { throw PilotIsDone(); };
    EXPECT_THROW(march(model, state, memory, plan, {}, stop), PilotIsDone);
    std::cout << each.name << ": " << memory.run.pilotIterations << " linear solves of the pilot\n";
    EXPECT_LE(memory.run.pilotIterations, 60);
    EXPECT_GT(memory.controller.scale.displacement, 1e-3);  // elastic ones are 1e-11
  }
}

}  // namespace mortier::controlled_march_test
