// The march as its callers have it, on a square in uniform stress: what it reports, where it stops, how it
// resumes.
#include "time/march.h"

#include <gtest/gtest.h>

#include <cmath>

#include "material/stress.h"
#include "time/measure.h"
#include "unit/pulled_square.h"

namespace mortier::march_test {

using namespace pulled;

struct Call {
  State state;
  StepReport report;
};

struct Marched {
  State state;
  RunReport report;
  std::vector<Call> calls;
};

Marched run(const Model& model, const TimePlan& plan, const SolverOptions& options = {}) {
  Marched result{initialState(model), {}, {}};
  result.report =
      march(model, result.state, plan, options, [&](const State& state, const StepReport& report) {
        result.calls.push_back({state, report});
      });
  return result;
}

/// The state and every number of a step that is no time taken.
void expectSame(const State& a, const State& b) {
  EXPECT_EQ(a.time, b.time);
  ASSERT_EQ(a.bodies.size(), b.bodies.size());
  for (size_t i = 0; i < a.bodies.size(); ++i) {
    EXPECT_EQ(a.bodies[i].displacement, b.bodies[i].displacement);
    EXPECT_EQ(a.bodies[i].stress, b.bodies[i].stress);
    EXPECT_EQ(a.bodies[i].viscoplasticStrain, b.bodies[i].viscoplasticStrain);
  }
}

TEST(March, observesTheInitialStateAndEveryStepAtItsTime) {
  const Model model = square([](double t) { return 2 * t; });
  const Marched result = run(model, {.end = 3, .steps = 6});
  ASSERT_EQ(result.report.status, Status::converged);
  ASSERT_EQ(result.calls.size(), 7);
  EXPECT_EQ(result.calls[0].report.step, 0);
  expectSame(result.calls[0].state, initialState(model));
  for (int k = 1; k <= 6; ++k) {
    const auto& [state, report] = result.calls[k];
    EXPECT_EQ(report.step, k);
    EXPECT_EQ(report.time, 0.5 * k);
    EXPECT_EQ(state.time, report.time);
    EXPECT_EQ(report.timeStep, 0.5);
  }
  expectSame(result.calls.back().state, result.state);
  EXPECT_EQ(result.state.time, 3);
}

TEST(March, beginsFromTheStateThatItIsGiven) {
  const Model model = square([](double t) { return t; });
  Marched first = run(model, {.end = 1, .steps = 4});
  MarchMemory memory;
  std::vector<double> times;
  const RunReport second = march(model, first.state, memory, {.end = 3, .steps = 4}, {},
                                 [&](const State& state, const StepReport&) { times.push_back(state.time); });
  EXPECT_EQ(second.status, Status::converged);
  EXPECT_EQ(memory.begin, 1);
  EXPECT_EQ(times, (std::vector<double>{1, 1.5, 2, 2.5, 3}));
  expectStress(first.state, 3);
}

TEST(March, everySchemeAddsUpTheFlowOfItsStages) {
  // The stress is known at every time, so the viscoplastic strain is a sum over stages.
  const auto load = [](double t) { return 1.5 * std::sin(0.4 + t); };
  constexpr int steps = 5;
  constexpr double k = 1.0 / steps;
  for (const Scheme scheme : {Scheme::backwardEuler, Scheme::crankNicolson, Scheme::sdirk2}) {
    const Model model = square(load);
    State state = initialState(model);
    state.bodies[0].stress = uniform(model, load(0));
    ASSERT_EQ(march(model, state, {.end = 1, .steps = steps, .scheme = scheme}, {}, unobserved).status,
              Status::converged);
    const Tableau stages = tableau(scheme);
    const Stage& last = stages.stages.back();
    Vector flow = Vector::Zero(3);
    for (int n = 0; n < steps; ++n) {
      std::vector<double> times;
      if (stages.explicitFirst) times.push_back(0);
      for (const Stage& stage : stages.stages) times.push_back(stage.time);
      for (size_t j = 0; j < times.size(); ++j) {
        const double weight = j < last.before.size() ? last.before[j] : last.diagonal;
        flow += k * weight * rate(model, load(k * (n + times[j])));
      }
    }
    const Matrix& strain = state.bodies[0].viscoplasticStrain;
    EXPECT_GT(flow.norm(), 0.05);
    EXPECT_LE((strain.colwise() - flow).cwiseAbs().maxCoeff(), 1e-11 * flow.norm());
    // Above the support at y = 0 the displacement is the strain in y, elastic and viscoplastic.
    const double strainAlongY = (flow[0] - flow[1]) / std::sqrt(2) + (load(1) - load(0)) / young;
    EXPECT_NEAR(topDisplacement(model, state), strainAlongY, 1e-11);
  }
}

TEST(March, theReportAddsUpItsSteps) {
  const Model model = square([](double t) { return 2 * std::sin(5 * t); });
  const Marched result = run(model, {.end = 1, .steps = 12});
  int iterations = 0;
  int factorisations = 0;
  int most = 0;
  double worst = 0;
  std::map<std::string, int> rungs;
  Peak vonMises;
  for (size_t i = 1; i < result.calls.size(); ++i) {
    const StepReport& step = result.calls[i].report;
    iterations += step.iterations;
    factorisations += step.factorisations;
    most = std::max(most, step.iterations);
    worst = std::max(worst, step.certificate.materialResidual);
    ++rungs[nameOf(step.method)];
    vonMises.raise(step.vonMises, step.time);
  }
  const RunReport& run = result.report;
  EXPECT_EQ(run.steps, 12);
  EXPECT_GT(iterations, 12);
  EXPECT_EQ(run.iterations, iterations);
  EXPECT_EQ(run.factorisations, factorisations);
  EXPECT_EQ(run.maxIterationsInAStep, most);
  EXPECT_EQ(run.worst.materialResidual, worst);
  EXPECT_EQ(run.rungs, rungs);
  EXPECT_EQ(run.peaks.vonMises.value, vonMises.value);
  EXPECT_EQ(run.peaks.vonMises.time, vonMises.time);
  EXPECT_NEAR(vonMises.value, 2 * std::sin(5 * vonMises.time), 1e-9);
  EXPECT_EQ(run.rejected, 0);
}

TEST(March, restsWhereNothingChanges) {
  const Model model = square([](double t) { return std::min(t, 0.5); });  // never beyond yield
  const Marched result = run(model, {.end = 1, .steps = 8});
  for (size_t i = 1; i < result.calls.size(); ++i) {
    const StepReport& report = result.calls[i].report;
    EXPECT_EQ(report.method, report.time <= 0.5 ? SolutionMethod::newton : SolutionMethod::rest)
        << report.time;
    EXPECT_EQ(report.iterations, report.time <= 0.5 ? 1 : 0) << report.time;
  }
  SolverOptions everything;
  everything.reduce = false;
  EXPECT_EQ(run(model, {.end = 1, .steps = 8}, everything).report.rungs.at("newton"), 8);
}

TEST(March, whatCannotBeSolvedIsCutAndThenEndsTheRunWithTheLastGoodState) {
  const Model model = square([](double t) { return t <= 0.45 ? t : NAN; });
  const Marched result = run(model, {.end = 1, .steps = 5});
  EXPECT_EQ(result.report.status, Status::failed);
  EXPECT_EQ(result.report.steps, 2);
  EXPECT_EQ(result.calls.size(), 3);
  EXPECT_EQ(result.report.reason.find("step 3 at t = 0.45"), 0) << result.report.reason;
  EXPECT_EQ(result.report.rejected, 8);  // halves, down to 1/256
  // The parts before the load ends are kept.
  EXPECT_NEAR(result.state.time, 0.4 + 0.2 * 64 / 256, 1e-15);
  expectStress(result.state, result.state.time);
}

// Backward Euler's strain shows at which times the parts end: halves, quarters and so on of the step.
TEST(March, thePartsOfAStepThatIsCutAreEqual) {
  constexpr double last = 0.46;
  const Model model = square([](double t) { return t <= last ? 4 * t : NAN; });
  const Marched result = run(model, {.end = 1, .steps = 5});
  Vector strain = 0.2 * (rate(model, 0.8) + rate(model, 1.6));
  double time = 0.4;
  for (double part = 0.1; part >= 0.2 / 256; part /= 2) {
    if (time + part > last) continue;
    time += part;
    strain += part * rate(model, 4 * time);
  }
  EXPECT_NEAR(result.state.time, time, 1e-15);
  EXPECT_LE((result.state.bodies[0].viscoplasticStrain.col(0) - strain).norm(), 1e-12 * strain.norm());
}

TEST(March, goesOnFromWhereAnObserverLeftIt) {
  struct Stop {};
  const Model model = square([](double t) { return 2 * std::sin(5 * t); });
  for (const double tolerance : {0.0, 1e-3}) {
    const TimePlan plan{.end = 1, .steps = 12, .scheme = Scheme::sdirk2, .tolerance = tolerance};
    const Marched whole = run(model, plan);
    ASSERT_EQ(whole.report.status, Status::converged) << whole.report.reason;
    State state = initialState(model);
    MarchMemory memory;
    EXPECT_THROW(march(model, state, memory, plan, {},
                       [](const State&, const StepReport& report) {
                         if (report.step == 4) throw Stop{};
                       }),
                 Stop);
    std::vector<int> steps;
    const RunReport rest = march(model, state, memory, plan, {}, [&](const State&, const StepReport& report) {
      steps.push_back(report.step);
    });
    EXPECT_EQ(steps.front(), 5);  // the initial state is not observed again
    expectSame(state, whole.state);
    EXPECT_EQ(rest.steps, whole.report.steps);
    EXPECT_EQ(rest.iterations, whole.report.iterations);
    EXPECT_EQ(rest.factorisations, whole.report.factorisations);
    EXPECT_EQ(rest.timeError, whole.report.timeError);
  }
}

TEST(March, rowsThatJoinAndLeaveTheActiveSetsAreCounted) {
  StepReport report;
  compareActive({{1, 0, 1, 0}, {0, 0}}, {{1, 1, 0, 0}, {1, 1}}, report);
  EXPECT_EQ(report.active, 4);
  EXPECT_EQ(report.joined, 3);
  EXPECT_EQ(report.left, 1);
}

TEST(March, theInitialStateIsUndeformedAndStepZeroHasWhatIsPrescribed) {
  Conditions conditions;
  conditions.displacements = {{bottom, alongY, [](double x, double, double t) { return 0.1 * x + t; }}};
  conditions.initialStresses = {{1, std::nullopt, constant(-3)}};
  Model model;
  conditions.displacements.push_back({bottom, alongX, constant(0)});
  model.bodies.emplace_back("held", crissCrossMesh({.cellsX = 2, .cellsY = 2}), elasticMaterial({1, 0.3}),
                            conditions);
  State state = initialState(model);
  EXPECT_EQ(state.time, 0);
  EXPECT_TRUE(state.bodies[0].displacement.isZero(0));
  for (int i = 0; i < model.bodies[0].points(); ++i)
    EXPECT_LE((toCartesian(state.bodies[0].stress.col(i)) - Eigen::Vector3d(0, -3, 0)).norm(), 1e-15);
  EXPECT_TRUE(state.bodies[0].viscoplasticStrain.isZero(0));
  bool seen = false;
  march(model, state, {.end = 1, .steps = 1}, {}, [&](const State& now, const StepReport& report) {
    if (report.step > 0) return;
    seen = true;
    for (size_t v = 0; v < model.bodies[0].mesh().vertices.size(); ++v) {
      const Point& x = model.bodies[0].mesh().vertices[v];
      if (x.y() == 0) {
        EXPECT_EQ(now.bodies[0].displacement[2 * v + 1], 0.1 * x.x());
      }
    }
    EXPECT_GT(report.vonMises, 0);
    EXPECT_LE(report.certificate.forceBalance, 1e-12);
  });
  EXPECT_TRUE(seen);
}

TEST(March, aBodyThatNothingHoldsIsNamedBeforeTheFirstStep) {
  Model model;
  model.bodies.emplace_back("loose", crissCrossMesh({.cellsX = 1, .cellsY = 1}), elasticMaterial({1, 0.3}),
                            Conditions{{{bottom, alongY, constant(0)}}, {}, {}});
  EXPECT_THROW(run(model, {}), UnheldBodyError);
}

}  // namespace mortier::march_test
