// Bodies that flow in space: Newton's method with a line search, linear solves with older factors completed
// by conjugate gradients, whether or not the conditions of contact yield.
#include <gtest/gtest.h>

#include <iostream>

#include "material/perzyna.h"
#include "mesh/shape.h"
#include "time/march.h"

namespace mortier::space_flow_test {

enum : int { bottom = 1, right, top, left, front, back };
constexpr double young = 1000;

Body block(const std::string& name, const Cuboid& cuboid, int held, double lowered) {
  Conditions conditions;
  for (const int c : {alongX, alongY, alongZ})
    conditions.displacements.push_back(
        {held, c, [lowered, c](const SpacePoint&, double t) { return c == alongZ ? -lowered * t : 0.0; }});
  return {name, cuboidMesh(cuboid), perzynaMaterial({young, 0.3}, {10, 1}, Plane::none),
          std::move(conditions), 2};
}

/// A punch with so many cells on a block with so many.
RunReport pressed(int fine, int coarse, State& state, std::optional<Model>& model) {
  model.emplace();
  model->bodies.push_back(block("punch", {{0.2, 0.2, 0}, {0.8, 0.8, 0.6}, {fine, fine, 3}}, top, 0.01));
  model->bodies.push_back(block("block", {{0, 0, -1}, {1, 1, 0}, {coarse, coarse, 4}}, bottom, 0));
  InterfaceOptions options;
  options.stabilised = true;
  options.mortarCompliance = 0.91 / young;
  addInterface(*model, {{0, bottom}, {1, top}, CouplingKind::weighted}, options);
  state = initialState(*model);
  return march(*model, state, {.end = 1, .steps = 2}, {}, [](const State&, const StepReport&) {});
}

TEST(SpaceFlow, takesFewIterationsAndFewerFactors) {
  for (const auto& [fine, coarse] : {std::pair(4, 6), std::pair(8, 3)}) {
    State state;
    std::optional<Model> model;
    const RunReport report = pressed(fine, coarse, state, model);
    ASSERT_EQ(report.status, Status::converged) << report.reason;
    EXPECT_EQ(model->interfaces[0].yields(), fine > coarse);
    EXPECT_GT(report.peaks.vonMises.value, 1);  // the yield stress
    EXPECT_LE(report.maxIterationsInAStep, 10);
    EXPECT_LE(report.factorisations, report.iterations);  // one of each body in each without
    EXPECT_LE(report.worst.forceBalance, 1e-12);
    EXPECT_LE(report.worst.materialResidual, 1e-10);
    EXPECT_LE(report.worst.complementarity, 1e-12);
    std::cout << fine << " on " << coarse << " cells: " << report.iterations << " iterations, "
              << report.factorisations << " factorisations, balance " << report.worst.forceBalance << "\n";
  }
}

}  // namespace mortier::space_flow_test
