// Factors in single precision, corrected, against those in double precision.
#include <gtest/gtest.h>

#include "material/deviatoric.h"
#include "mesh/shape.h"
#include "time/march.h"

namespace mortier::single_precision_test {

enum : int { bottom = 1, top = 3, left = 4, front = 5 };

struct Result {
  State state;
  RunReport report;
};

Result solve(const Model& model, LinearEngine engine, int threads = 1) {
  Result result{initialState(model), {}};
  SolverOptions options;
  options.linear = engine;
  options.threads = threads;
  result.report =
      march(model, result.state, {.end = 1, .steps = 2}, options, [](const State&, const StepReport&) {});
  EXPECT_EQ(result.report.status, Status::converged) << result.report.reason;
  return result;
}

void expectEqual(const Model& model, const Result& one, const Result& other, double rounding) {
  for (size_t b = 0; b < model.bodies.size(); ++b) {
    const Vector u = one.state.bodies[b].displacement;
    const double size = u.lpNorm<Eigen::Infinity>();
    EXPECT_LE((u - other.state.bodies[b].displacement).lpNorm<Eigen::Infinity>(), rounding * size);
  }
  for (size_t k = 0; k < model.interfaces.size(); ++k) {
    const Vector& p = one.state.contactForce[k];
    EXPECT_LE((p - other.state.contactForce[k]).lpNorm<Eigen::Infinity>(),
              rounding * p.lpNorm<Eigen::Infinity>());
  }
}

const Datum zero = [](const SpacePoint&, double) { return 0.0; };

/// A block on another one, pressed at one side so that it lifts off at the other; contact alone holds it.
Model pressedBlocks(bool flows) {
  const Datum load = [](const SpacePoint& x, double t) { return -t * (x.x() < 0.5 ? 1 : 0); };
  const auto material = flows ? perzynaMaterial({1000, 0.3}, {10, 0.5, Projection::elasticity}, Plane::none)
                              : elasticMaterial({1000, 0.3}, Plane::none);
  Model model;
  model.bodies.emplace_back("upper", cuboidMesh({{0.2, 0.2, 0}, {0.8, 0.8, 0.3}, {6, 6, 3}}), material,
                            Conditions{{{left, alongX, zero}, {front, alongY, zero}}, {{top, alongZ, load}}},
                            2);
  model.bodies.emplace_back(
      "lower", cuboidMesh({{0, 0, -0.5}, {1, 1, 0}, {7, 7, 4}}), material,
      Conditions{{{bottom, alongX, zero}, {bottom, alongY, zero}, {bottom, alongZ, zero}}, {}}, 2);
  addInterface(model, {{0, bottom}, {1, top}, CouplingKind::weighted});
  return model;
}

TEST(SinglePrecision, leavesResultsAsTheyAre) {
  const Model model = pressedBlocks(false);
  const Result exact = solve(model, LinearEngine::multifrontal);
  const Result corrected = solve(model, LinearEngine::single);
  expectEqual(model, exact, corrected, 1e-11);
  EXPECT_GT(corrected.report.iterations, exact.report.iterations);  // it was in single precision
  EXPECT_LE(corrected.report.iterations, 6 * exact.report.iterations);
  EXPECT_EQ(corrected.report.factorisations, exact.report.factorisations);
  const Result onThreads = solve(model, LinearEngine::single, 3);
  EXPECT_TRUE(onThreads.state.contactForce[0] == corrected.state.contactForce[0]);
}

TEST(SinglePrecision, servesBodiesThatFlow) {
  const Model model = pressedBlocks(true);
  const Result exact = solve(model, LinearEngine::multifrontal);
  const Result corrected = solve(model, LinearEngine::single);
  expectEqual(model, exact, corrected, 1e-8);                       // both stop at a residual of 1e-10
  EXPECT_GE(corrected.report.iterations, exact.report.iterations);  // linear solves are completed
}

// A bar so slender that single precision has nothing left of its stiffness against bending.
TEST(SinglePrecision, isGivenUpWhereItDoesNotDo) {
  const Datum load = [](const SpacePoint&, double t) { return t; };
  Model model;
  model.bodies.emplace_back(
      "bar", cuboidMesh({{0, 0, 0}, {400, 1, 1}, {400, 1, 1}}), elasticMaterial({1000, 0.3}, Plane::none),
      Conditions{{{left, alongX, zero}, {left, alongY, zero}, {left, alongZ, zero}}, {{top, alongZ, load}}},
      1);
  const Result exact = solve(model, LinearEngine::multifrontal);
  const Result given = solve(model, LinearEngine::single);
  EXPECT_GT(given.report.factorisations, exact.report.factorisations);
  const Vector u = exact.state.bodies[0].displacement;
  EXPECT_LE((u - given.state.bodies[0].displacement).norm(), 1e-6 * u.norm());  // its condition is 1e10
}

}  // namespace mortier::single_precision_test
