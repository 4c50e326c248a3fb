// Steps chosen by their error: what a tolerance buys, and what it must not depend on.
#include <gtest/gtest.h>

#include <iostream>
#include <numbers>

#include "theory/controlled_runs.h"
#include "theory/pressed_blocks.h"
#include "theory/scenes.h"
#include "theory/time_cases.h"
#include "time/breaks.h"
#include "time/error_norms.h"
#include "time/step_taker.h"

namespace mortier::error_control_test {

using namespace scenes;

// ---- the note's test

struct NotesRun {
  RunReport run;
  double top = 0;     ///< u2 on top [m]
  double spread = 0;  ///< of u2 along the top [m]
};

NotesRun notesRun(CouplingKind coupling, const TimePlan& plan) {
  const Model model = compression(6, 16, perzynaMaterial(noteElasticity, noteLaw(Projection::elasticity)),
                                  coupling, upperBody);
  State state = initialState(model);
  NotesRun result{runWith(model, state, plan)};
  EXPECT_EQ(result.run.status, Status::converged) << result.run.reason;
  EXPECT_EQ(state.time, plan.end);
  const Range u2 =
      displacementRange(model.bodies[0], state.bodies[0], 1, [](const Point& x) { return x.y() == 1; });
  result.top = u2.mean();
  result.spread = u2.max - u2.min;
  return result;
}

constexpr double exactTop = -0.39250058416512;

TEST(ErrorControl, theErrorOfTheNotesTestFollowsTheTolerance) {
  struct Bound {
    double tolerance;
    int solves;
  };
  const Bound bounds[] = {{1e-2, 30}, {1e-3, 34}, {1e-4, 34}, {1e-5, 100}, {1e-6, 180}};
  for (const Bound& bound : bounds) {
    const NotesRun result = notesRun(CouplingKind::mortar, controlled(1, bound.tolerance));
    const double error = std::abs(result.top / exactTop - 1);
    print("tolerance " + std::to_string(bound.tolerance), result.run);
    // Backward Euler's error is 1.13/N (SchemesTest fits it).
    std::cout << ", error " << error << " = " << error / bound.tolerance
              << " of the tolerance; backward Euler needs about " << static_cast<int>(1.13 / error)
              << " steps\n";
    EXPECT_LT(error, bound.tolerance);
    EXPECT_LT(result.run.timeError, bound.tolerance);
    EXPECT_GT(result.run.timeError, 0.9 * error);
    EXPECT_LT(result.spread, 1e-9);
    EXPECT_LE(result.run.iterations, bound.solves);
    if (bound.tolerance == 1e-4) {
      EXPECT_LE(result.run.steps, 11);
    }
  }
}

// Interpolation, coarse side nonmortar: the triangles along the interface yield one after the other from t =
// 0.04 on. The reference is SDIRK2 with 640 and 1280 equal steps, which agree to 2e-8.
TEST(ErrorControl, interpolationDoesNotStall) {
  constexpr double reference = -0.404520189;
  constexpr int solvesOfEqualSteps = 293;
  const NotesRun result = notesRun(CouplingKind::interpolation, controlled(1, 2e-4));
  const double error = std::abs(result.top / reference - 1);
  print("interpolation", result.run);
  std::cout << ", error " << error << "\n";
  EXPECT_LT(error, 1e-4);
  EXPECT_LT(result.run.iterations, solvesOfEqualSteps);
}

// Triangles that yield one after the other stop Newton's method alone, of shorter steps as well: the methods
// that come after it solve steps as long as the tolerance allows.
TEST(ErrorControl, toleranceAndNotTheMethodDecidesHowManySteps) {
  constexpr double reference = -0.404520189;
  constexpr int most = 20;
  for (const double tolerance : {6e-4, 4.8e-4, 3.84e-4, 3.07e-4}) {
    TimePlan plan = controlled(1, tolerance);
    plan.steps = 100;  // the first one is as long as one of these
    const NotesRun result = notesRun(CouplingKind::interpolation, plan);
    const double error = std::abs(result.top / reference - 1);
    print("tolerance " + std::to_string(tolerance), result.run);
    std::cout << ", error " << error << "\n";
    EXPECT_LT(error, tolerance);
    EXPECT_LE(result.run.steps, most);
  }
}

TEST(ErrorControl, backwardEulerMeetsATolerance) {
  const NotesRun result = notesRun(CouplingKind::mortar, controlled(1, 1e-2, Scheme::backwardEuler));
  const double error = std::abs(result.top / exactTop - 1);
  print("backward Euler", result.run);
  std::cout << ", error " << error << "\n";
  EXPECT_LT(error, 1e-2);
  EXPECT_GT(error, 3e-3);
  EXPECT_LE(result.run.steps, 130);
  EXPECT_LT(result.run.steps, 1.13 / error);  // equal ones with that error
}

TEST(ErrorControl, unitsDoNotChangeTheSteps) {
  struct Units {
    double length, stress, time;
  };
  std::vector<RunReport> runs;
  for (const Units& units : {Units{1, 1, 1}, Units{1024, 0x1p-20, 0x1p10}, Units{1e3, 1e-6, 3600}}) {
    const double load = 10 * units.stress / units.time;
    const double side = units.length;
    const auto material = perzynaMaterial(
        {3e11 * units.stress, 0.3}, {10 * units.stress * units.time, units.stress, Projection::frobenius});
    const auto square = [&](double y, int cells) {
      return crissCrossMesh(
          {.lower = {0, y * side}, .upper = {side, (y + 1) * side}, .cellsX = cells, .cellsY = cells});
    };
    Body upper(
        "upper", square(0, 3), material,
        {{{left, 0, constant(0)}}, {{top, 1, [load](double, double, double t) { return -load * t; }}}, {}});
    Body lower("lower", square(-1, 4), material,
               {{{left, 0, constant(0)}, {bottom, 1, constant(0)}}, {}, {}});
    const Model model = contactModel(std::move(upper), std::move(lower), CouplingKind::mortar, upperBody);
    State state = initialState(model);
    runs.push_back(runWith(model, state, controlled(units.time, 1e-5)));
  }
  for (const RunReport& run : runs) {
    EXPECT_EQ(run.status, Status::converged);
    EXPECT_EQ(run.steps, runs[0].steps);
    EXPECT_EQ(run.rejected, runs[0].rejected);
    EXPECT_EQ(run.iterations, runs[0].iterations);
  }
}

// ---- loads of many kinds

// Those that take little time, the stress uniform and the error exact.
TEST(ErrorControl, theToleranceIsTheErrorOfEveryStepUnderLoadsOfManyKinds) {
  for (const timecases::Case& each : timecases::cases(timecases::Size::small)) {
    if (each.coupling != CouplingKind::mortar || each.young > 1e6) continue;
    const timecases::Truth truth(each);
    for (const double tolerance : {1e-2, 1e-3}) {
      SCOPED_TRACE(each.name + ", tolerance " + std::to_string(tolerance));
      const timecases::Outcome run = timecases::controlledRun(each, truth, tolerance);
      EXPECT_FALSE(run.told) << run.reason;
      EXPECT_LE(run.error, 1.5 * tolerance);
      EXPECT_GE(run.estimate, 0.3 * run.error - timecases::rounding);
      EXPECT_LE(run.estimate, std::max(4 * run.error, 0.5 * tolerance));
    }
  }
}

// Steps of any length end on troughs, where nothing flows; the first stage of a run sees the load of t = 0.
TEST(ErrorControl, noStepJumpsOverCyclesOrOverTheLoadAtTheStart) {
  for (const char* load : {"8 low waves", "at t = 0"})
    for (const timecases::Case& each : timecases::cases(timecases::Size::small)) {
      if (each.load.name != std::string(load) || each.coupling != CouplingKind::mortar || each.young > 1e6)
        continue;
      const timecases::Truth truth(each);
      TimePlan plan = each.plan(each.scheme, 1e-2);
      plan.steps = 1;
      const timecases::Outcome run = timecases::runOf(each, truth, plan);
      EXPECT_TRUE(run.reason.empty()) << run.reason;
      EXPECT_LE(run.error, 1.5e-2) << each.name;
    }
}

// With interpolation the triangles along the interface yield one after the other. A step over the first of
// them that ends among them knows only the last direction of their flow.
TEST(ErrorControl, theFirstStepThatFlowsIsAsGoodAsTheToleranceAsks) {
  for (const timecases::Case& each : timecases::cases(timecases::Size::small)) {
    if (each.name != "8 low waves, hard, interpolation, sdirk2") continue;
    constexpr double tolerance = 1e-5;
    struct Seen {};
    const Model model = each.model();
    const ErrorMeasure measure(model);
    State state = initialState(model);
    State before = state;
    MarchMemory memory;
    double error = 0;
    EXPECT_THROW((void)march(model, state, memory, each.plan(each.scheme, tolerance), {},
                             [&](const State& now, const StepReport&) {
                               if (StepTaker(model, state, memory, each.scheme, {}).flowing() == 0) {
                                 before = now;
                                 return;
                               }
                               (void)march(model, before,
                                           {.end = now.time, .steps = 128, .scheme = each.scheme}, {},
                                           [](const State&, const StepReport&) {});
                               std::vector<Response> missed;
                               for (size_t b = 0; b < now.bodies.size(); ++b)
                                 missed.push_back({now.bodies[b].displacement - before.bodies[b].displacement,
                                                   now.bodies[b].stress - before.bodies[b].stress});
                               error = measure.sizeOf(missed).stress / memory.controller.scale.stress;
                               throw Seen{};
                             }),
                 Seen);
    std::cout << "error of the first step that flows: " << error << "\n";
    EXPECT_GT(error, 0);
    EXPECT_LT(error, tolerance);
  }
}

// ---- open, close, reclose

TEST(ErrorControl, openCloseRecloseToTheTolerance) {
  for (const double tolerance : {1e-2, 1e-3, 1e-4, 1e-5, 1e-6})
    for (const CouplingKind coupling : {CouplingKind::mortar, CouplingKind::interpolation}) {
      const Model model = pressedBlocks(coupling);
      TimePlan plan = controlled(4, tolerance);
      plan.breaks = resolve(pathOfTheTop, 0, 4).breaks;
      EXPECT_EQ(plan.breaks, (std::vector<double>{1, 2, 3}));
      OpenClose values(model);
      State state = initialState(model);
      const RunReport run = runWith(model, state, plan, values.observer());
      SCOPED_TRACE(tolerance);
      ASSERT_EQ(run.status, Status::converged) << run.reason;
      print(scenes::nameOf(coupling), run);
      std::cout << ", tolerance " << tolerance << ": s(1) " << values.stress[1].mean() << ", s(2) "
                << values.stress[2].mean() << ", gap(3) " << values.gapAt3.mean() << ", s(4) "
                << values.stress[4].mean() << "\n";
      EXPECT_EQ(count(run, "cut"), 0);
      if (coupling == CouplingKind::mortar) {
        EXPECT_LT(values.stress[1].distance(exactAfterRamp), tolerance);
        EXPECT_LT(values.stress[2].distance(1), tolerance);
        EXPECT_LT(values.gapAt3.distance(0.04), 0.04 * tolerance);
        EXPECT_LT(values.stress[4].distance(1), tolerance);
      } else {
        // The stress is not uniform; against 640 equal steps: 0.14185 and 0.14195 at most from 1, gaps to
        // 0.0412687.
        EXPECT_NEAR(values.stress[2].distance(1), 0.1419, std::max(1.5 * tolerance, 2e-4));
        EXPECT_NEAR(values.gapAt3.max, 0.0412687, 0.04 * std::max(tolerance, 1e-4));
      }
    }
}

// ---- a load that reverses twenty times

// The top goes down and up by 0.04 like a saw. Contact opens in each ascent; in each descent the blocks flow
// only at its very end, a little less each time: equal steps see little of it.
TEST(ErrorControl, twentyReversals) {
  constexpr double lastPeak = 1.0045361;  // tolerances 1e-7 and 1e-8 agree
  constexpr double end = 21;
  const auto saw = [](double t) {
    return -0.02 * (1 - 2 / std::numbers::pi * std::asin(std::cos(std::numbers::pi * t)));
  };
  const Model model = pressedBlocks(CouplingKind::mortar, [saw](double, double, double t) { return saw(t); });
  const auto errorOf = [&](const TimePlan& plan) {
    State state = initialState(model);
    const RunReport run = runWith(model, state, plan);
    EXPECT_EQ(run.status, Status::converged) << run.reason;
    EXPECT_EQ(count(run, "cut"), 0);
    Range stress;
    for (const BodyState& body : state.bodies)
      for (Eigen::Index i = 0; i < body.stress.cols(); ++i) stress.add(-toCartesian(body.stress.col(i))[1]);
    print("twenty reversals", run);
    std::cout << ", error of the last peak " << stress.distance(lastPeak) << "\n";
    return stress.distance(lastPeak);
  };
  const double equal = errorOf({.end = end, .steps = 21 * 20, .scheme = Scheme::sdirk2});
  for (const double tolerance : {1e-4, 1e-5}) {
    TimePlan plan = controlled(end, tolerance);
    plan.breaks = resolve(saw, 0, end).breaks;
    ASSERT_EQ(plan.breaks.size(), 20);
    const double chosen = errorOf(plan);
    EXPECT_LT(chosen, 4 * tolerance);  // what twenty cycles add up to
    EXPECT_LT(chosen, equal / 5);
  }
}

}  // namespace mortier::error_control_test
