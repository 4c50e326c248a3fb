// The hard cases must converge within the limits of their certificate.
#include "theory/hard_cases.h"

#include <gtest/gtest.h>

#include <iostream>

#include "solver/methods.h"
#include "solver/solve_step.h"

namespace mortier::hard_cases_test {

using namespace hardcases;

/// The norm of the projection weighs the deviator 19 times as much as the pressure.
constexpr const char* pathIsAMaze = "data, nu -0.9, interpolation, elasticity, N 10";

void expectWithinLimits(const std::string& family) {
  int count = 0;
  for (const HardCase& hard : hardCases()) {
    if (hard.slow || hard.name.find(family) != 0 || hard.name == pathIsAMaze) continue;
    SCOPED_TRACE(hard.name);
    const HardResult result = solve(hard.model(), hard.plan);
    const Certificate& worst = result.report.worst;
    EXPECT_EQ(result.report.status, Status::converged) << result.report.reason;
    EXPECT_LE(worst.forceBalance, forceBalanceLimit);
    EXPECT_LE(worst.materialResidual, materialResidualLimit);
    EXPECT_LE(worst.complementarity, complementarityLimit);
    EXPECT_LE(worst.gapOnActive, gapOnActiveLimit);
    ++count;
  }
  EXPECT_GT(count, 0);
  std::cout << count << " cases\n";
}

TEST(HardCases, coarseNonmortar) {
  expectWithinLimits("coarse nonmortar");
}
TEST(HardCases, data) {
  expectWithinLimits("data");
}
TEST(HardCases, geometry) {
  expectWithinLimits("geometry");
}
TEST(HardCases, eccentricLoad) {
  expectWithinLimits("eccentric");
}

// ---- steps with several solutions

// The solutions of the tenth step for all viscosities lie on a curve that turns back twice: no way leads on
// at a viscosity that only falls.
TEST(HardCases, pathTurnsBackAndGoesOn) {
  constexpr int steps = 50;
  constexpr int before = 9;
  const Model model = eccentric(Projection::elasticity, true);
  State state = initialState(model);
  const RunReport report = march(model, state, {.end = 1.0 * before / steps, .steps = before}, {},
                                 [](const State&, const StepReport&) {});
  ASSERT_EQ(report.status, Status::converged);
  StepSystem system(model, {});
  const StepData data{1.0 * (before + 1) / steps, 1.0 / steps, {}};
  const Step step = system.step(state, data);
  ViscosityContinuation continuation(model, step);
  Iterate solution;
  const StepOutcome outcome = followCurve(system, step, continuation, 1500, solution);
  EXPECT_TRUE(outcome.converged()) << outcome.detail;
  EXPECT_LE(outcome.certificate.materialResidual, materialResidualLimit);
  EXPECT_LE(outcome.certificate.forceBalance, forceBalanceLimit);
  std::cout << outcome.iterations << " linear solves, turns at";
  for (const double decades : continuation.turningPoints) std::cout << " 10^" << decades;
  std::cout << " times the viscosity\n";
  EXPECT_GE(continuation.turningPoints.size(), 2);
}

// ---- steps that are given up

TEST(HardCases, aStepWhoseCurveHasNoEndIsGivenUp) {
  int count = 0;
  for (const HardCase& hard : hardCases()) {
    if (hard.name != pathIsAMaze) continue;
    ++count;
    const HardResult result = solve(hard.model(), hard.plan);
    EXPECT_EQ(result.report.status, Status::failed);
    EXPECT_NE(result.report.reason.find("curve of solutions"), std::string::npos) << result.report.reason;
  }
  EXPECT_EQ(count, 1);
}

TEST(HardCases, whatIsGivenUpHasAReasonAndKeepsToItsLimit) {
  int givenUp = 0;
  for (const Projection projection : projections)
    for (const int most : {1, 2, 3, 5, 8, 12, 30, 70, 110}) {
      Compression scene;
      scene.coupling = CouplingKind::interpolation;
      scene.upperLaw.projection = scene.lowerLaw.projection = projection;
      SolverOptions options;
      options.maxIterations = most;
      const Model model = scene.model();
      StepSystem system(model, options);
      const State state0 = initialState(model);
      Iterate iterate = startingIterate(state0);
      const StepOutcome outcome = solveStep(system, state0, {0.2, 0.2, {}}, iterate, Effort::all);
      EXPECT_LE(outcome.iterations, most);
      EXPECT_EQ(outcome.converged(), outcome.detail.empty()) << most << " " << nameOf(projection);
      givenUp += outcome.converged() ? 0 : 1;
    }
  EXPECT_GE(givenUp, 6);
}

// ---- where methods begin

TEST(HardCases, proximalWeightAndStartOfTheInteriorPathDoNotMatter) {
  constexpr double tolerance = 1e-10;
  const Model model = eccentric(Projection::frobenius, true);
  const auto solved = [&](const SolverOptions& options) {
    scenes::Result result = scenes::run(model, 1, 20, options);
    EXPECT_EQ(result.report.status, Status::converged) << result.report.reason;
    return result;
  };
  const SolverOptions usual;
  const scenes::Result expected = solved(usual);
  const auto compare = [&](const std::string& what, const SolverOptions& options) {
    const scenes::Result result = solved(options);
    const Vector& u = expected.state.bodies[0].displacement;
    const double change =
        (result.state.bodies[0].displacement - u).cwiseAbs().maxCoeff() / u.cwiseAbs().maxCoeff();
    std::cout << what << ": changed by " << change << ", " << result.report.iterations
              << " linear solves (usual " << expected.report.iterations << ")\n";
    EXPECT_LE(change, tolerance) << what;
  };
  for (const double factor : {1e-4, 1e-2, 1e2, 1e3, 1e4}) {
    SolverOptions options;
    options.proximalWeight *= factor;
    compare("proximal weight times " + number(factor), options);
  }
  for (const double overstress : {10.0, 1e3, 1e4}) {
    SolverOptions options;
    options.firstOverstress = overstress;
    compare("interior path from " + number(overstress) + " yield stresses", options);
  }
}

}  // namespace mortier::hard_cases_test
