// Steps chosen by their error, one at a time, on a square whose stress is known at every time.
#include "time/controller.h"

#include <gtest/gtest.h>

#include <cmath>

#include "unit/pulled_square.h"

namespace mortier::controller_test {

using namespace pulled;

/// A march with tolerance taken apart: what march() prepares, and steps one by one.
struct Taken {
  Taken(const std::function<double(double)>& load, TimePlan timePlan, const SolverOptions& options = {})
      : model(square(load)),
        plan(std::move(timePlan)),
        state(initialState(model)),
        controller(model, plan, memory) {
    {
      StepTaker pilot(model, state, memory, Scheme::backwardEuler, options);
      controller.pilot(pilot, state);
    }
    controller.begin(state);
    taker.emplace(model, state, memory, plan.scheme, options);
  }

  /// One step; as in march(), the run records it.
  StepReport advance() {
    StepReport report;
    report.step = memory.run.steps + 1;
    controller.advance(*taker, state, report);
    memory.run.rejected += report.rejections;
    if (report.status == Status::converged) memory.run.steps = report.step;
    return report;
  }
  std::vector<StepReport> advanceToTheEnd() {
    std::vector<StepReport> reports;
    while (state.time < plan.end) {
      reports.push_back(advance());
      if (reports.back().status != Status::converged) break;
    }
    return reports;
  }

  Model model;
  TimePlan plan;
  State state;
  MarchMemory memory;
  Controller controller;
  std::optional<StepTaker> taker;
};

TimePlan planOf(double tolerance, Scheme scheme = Scheme::sdirk2) {
  return {.end = 1, .steps = 0, .scheme = scheme, .tolerance = tolerance};
}

double wave(double t) {
  return 1.5 * std::sin(9 * t);
}

TEST(Controller, thePilotLeavesTheStateAndFindsTheScales) {
  const Taken taken(wave, planOf(1e-3));
  EXPECT_EQ(taken.state.time, 0);
  EXPECT_TRUE(taken.state.bodies[0].displacement.isZero(0));
  EXPECT_TRUE(taken.state.bodies[0].stress.isZero(0));
  EXPECT_EQ(taken.memory.run.steps, 0);
  EXPECT_EQ(taken.memory.controller.trial, 1);
  EXPECT_GT(taken.memory.run.pilotIterations, 0);
  EXPECT_EQ(taken.memory.run.iterations, taken.memory.run.pilotIterations);
  // Of its five steps those at t = 0.2 and 0.8 have the largest stresses; |s|_E = |s|/sqrt(young) on the unit
  // square.
  const double largest = std::max(std::abs(wave(0.2)), std::max(std::abs(wave(0.6)), std::abs(wave(0.8))));
  EXPECT_NEAR(taken.memory.controller.scale.stress, largest / std::sqrt(young), 1e-9 * largest);
}

TEST(Controller, thePlanMayNameTheFirstStep) {
  TimePlan plan = planOf(1e-3);
  plan.steps = 50;
  const Taken named(wave, plan);
  EXPECT_EQ(named.memory.controller.timeStep, 1.0 / 50);
  const Taken chosen(wave, planOf(1e-3));
  EXPECT_GT(chosen.memory.controller.timeStep, 0);
  EXPECT_LT(chosen.memory.controller.timeStep, 0.1);
}

TEST(Controller, stepsEndOnTheBreaksAndOnTheEnd) {
  TimePlan plan = planOf(1e-2);
  plan.breaks = {-1, 0.3, 0.3000001, 0.77, 5};  // what lies outside is none
  Taken taken(wave, plan);
  std::vector<double> times;
  for (const StepReport& report : taken.advanceToTheEnd()) {
    EXPECT_EQ(report.status, Status::converged) << report.reason;
    EXPECT_EQ(report.timeStep, report.time - (times.empty() ? 0 : times.back()));
    EXPECT_GT(report.timeStep, 0);
    times.push_back(report.time);
  }
  for (const double t : {0.3, 0.3000001, 0.77, 1.0})
    EXPECT_EQ(std::count(times.begin(), times.end(), t), 1) << t;
  EXPECT_EQ(times.back(), 1);
}

TEST(Controller, noStepJumpsOverAPulse) {
  const auto pulse = [](double t) { return 0.1 * t + (t > 0.61 && t < 0.63 ? 0.5 : 0.0); };
  TimePlan plan = planOf(1e-2);
  plan.data = {resolve(pulse, 0, 1)};
  plan.breaks = plan.data[0].breaks;
  Taken taken(pulse, plan);
  bool inside = false;
  for (const StepReport& report : taken.advanceToTheEnd())
    inside = inside || (report.time > 0.61 && report.time < 0.63 + 1e-9);
  EXPECT_TRUE(inside);
}

TEST(Controller, theEstimateIsTheErrorOfEveryStep) {
  constexpr double parts = 2e4;
  for (const Scheme scheme : {Scheme::backwardEuler, Scheme::sdirk2}) {
    TimePlan plan = planOf(1e-2, scheme);
    plan.data = {resolve(wave, 0, 1)};
    Taken taken(wave, plan);
    Vector flow = Vector::Zero(3);
    double t = 0;
    double largest = 0;
    double worst = 0;
    while (taken.state.time < 1) {
      const StepReport report = taken.advance();
      ASSERT_EQ(report.status, Status::converged) << report.reason;
      for (; t + 0.5 / parts < taken.state.time; t += 1 / parts)
        flow += rate(taken.model, wave(t + 0.5 / parts)) / parts;
      const double exact = wave(t) / young + (flow[0] - flow[1]) / std::sqrt(2);
      largest = std::max(largest, std::abs(exact));
      worst = std::max(worst, std::abs(topDisplacement(taken.model, taken.state) - exact));
    }
    EXPECT_GT(taken.controller.worst(), 0.3 * worst / largest);
    EXPECT_LT(taken.controller.worst(), 3 * worst / largest);
  }
}

TEST(Controller, aStepThatIsTooLongIsRejectedAndTheNextAreLongEnough) {
  TimePlan plan = planOf(1e-4);
  plan.steps = 1;
  Taken taken(wave, plan);
  const StepReport first = taken.advance();
  EXPECT_GT(first.rejections, 0);
  EXPECT_LT(first.time, 0.5);
  int rejections = 0;
  int steps = 0;
  for (const StepReport& report : taken.advanceToTheEnd()) {
    rejections += report.rejections;
    ++steps;
  }
  EXPECT_LE(rejections, steps);
}

TEST(Controller, aRunThatMissesItsToleranceBeginsAgainWithSmallerErrorsOfItsSteps) {
  TimePlan plan = planOf(1e-3);
  plan.maxSteps = 1000000000;
  Taken taken(wave, plan);
  taken.advanceToTheEnd();
  taken.memory.controller.worst = {};
  EXPECT_FALSE(taken.controller.beginAgain(taken.state));  // it meets it
  EXPECT_EQ(taken.state.time, 1);
  constexpr int trials = 10;
  for (int trial = 2; trial <= trials; ++trial) {
    ControllerMemory& own = taken.memory.controller;
    taken.state.time = 1;
    own.worst = {2e-3 * own.largest.stress, 0};  // twice the tolerance
    const double local = own.local;
    ASSERT_TRUE(taken.controller.beginAgain(taken.state)) << trial;
    EXPECT_EQ(own.trial, trial);
    EXPECT_EQ(taken.state.time, 0);
    EXPECT_TRUE(taken.state.bodies[0].stress.isZero(0));
    EXPECT_EQ(taken.memory.run.steps, 0);
    EXPECT_NEAR(own.local / local, std::pow(0.7 / 2, 1.5), 1e-12);  // local ~ global^((p+1)/p)
  }
  taken.state.time = 1;
  taken.memory.controller.worst = taken.memory.controller.largest;
  EXPECT_FALSE(taken.controller.beginAgain(taken.state));  // that was the last trial
}

TEST(Controller, aTrialEndsWhenItHasCostTwiceWhatItTookToMissTheTolerance) {
  Taken taken(wave, planOf(1e-3));
  ControllerMemory& own = taken.memory.controller;
  const int before = taken.memory.run.iterations;
  EXPECT_FALSE(taken.controller.abandons());
  const auto continueTo = [&](int iterations, double error) {
    taken.state.time = 0.1;
    taken.memory.run.iterations = before + iterations;
    own.worst = {error * own.scale.stress, 0};
    return taken.controller.abandons();
  };
  EXPECT_FALSE(continueTo(10, 0.9e-3));
  EXPECT_FALSE(continueTo(20, 1.1e-3));
  EXPECT_FALSE(continueTo(39, 1.5e-3));
  EXPECT_TRUE(continueTo(40, 2e-3));
  const double local = own.local;
  const double scale = own.scale.stress;
  ASSERT_TRUE(taken.controller.beginAgain(taken.state));
  EXPECT_EQ(own.scale.stress, scale);  // the run so far does not show how large the stress will be
  EXPECT_NEAR(own.local / local, std::pow(0.4 / 2, 1.5), 1e-12);
  EXPECT_EQ(taken.memory.run.pilotIterations, before + 40);
  EXPECT_FALSE(taken.controller.abandons());
}

TEST(Controller, allOfMaxStepsUsedIsTheReason) {
  TimePlan plan = planOf(1e-4);
  plan.maxSteps = 4;
  Taken taken(wave, plan);
  const std::vector<StepReport> reports = taken.advanceToTheEnd();
  EXPECT_EQ(reports.back().status, Status::failed);
  EXPECT_NE(reports.back().reason.find("max_steps = 4"), std::string::npos) << reports.back().reason;
  int attempts = 0;
  for (const StepReport& report : reports)
    attempts += report.rejections + (report.status == Status::converged ? 1 : 0);
  EXPECT_EQ(attempts, 4);
  EXPECT_LT(taken.state.time, 1);
}

TEST(Controller, attemptsThatCannotBeSolvedShortenTheStepAndAreCounted) {
  Taken taken([](double t) { return t == 0 ? 0 : NAN; }, planOf(1e-3));
  const double first = taken.memory.controller.timeStep;
  const StepReport report = taken.advance();
  EXPECT_EQ(report.status, Status::failed);
  EXPECT_EQ(report.reason.find("step 1 at t = "), 0) << report.reason;
  EXPECT_EQ(report.rejections, 14);
  EXPECT_NEAR(taken.memory.controller.timeStep, first * std::pow(0.25, 13), 1e-9 * first);
  EXPECT_EQ(taken.state.time, 0);
}

// Where a hundred steps, one in four, had parts that could not be solved, the pace counts.
TEST(Controller, aRunThatCrawlsIsGivenUpWithTheReasonOfItsAttempts) {
  for (const int cut : {99, 100}) {
    TimePlan plan = planOf(1e-3);
    plan.maxSteps = 1000;
    Taken taken([](double t) { return t == 0 ? 0 : NAN; }, plan);
    taken.memory.run.steps = 400;
    taken.memory.run.rungs["cut"] = cut;
    const StepReport report = taken.advance();
    EXPECT_EQ(report.status, Status::failed);
    EXPECT_NE(report.reason.find("did not converge"), std::string::npos) << report.reason;
    EXPECT_EQ(report.reason.find("max_steps = 1000") != std::string::npos, cut == 100) << report.reason;
    EXPECT_EQ(report.rejections, cut == 100 ? 4 : 14);  // 1/24/4^3 < 1/1000
  }
}

}  // namespace mortier::controller_test
