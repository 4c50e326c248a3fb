// A linear solve part by part, against one dense system of both bodies.
#include "solver/step_system.h"

#include <gtest/gtest.h>

#include <Eigen/LU>

#include "material/overstress.h"
#include "material/perzyna.h"
#include "mesh/generate.h"
#include "mesh/shape.h"
#include "solver/methods.h"
#include "solver/solve_step.h"
#include "time/march.h"
#include "unit/dense_reference.h"

namespace mortier::step_system_test {

constexpr double rounding = 1e-12;

Function constant(double value) {
  return [value](double, double, double) { return value; };
}

/// Two squares, the upper one pressed on the lower one with a load that pulls at its left end.
Model squares(std::shared_ptr<const Material> material, double shear = 0) {
  Model model;
  model.bodies.emplace_back(
      "upper", crissCrossMesh({{0, 0}, {1, 1}, 2, 2}), material,
      Conditions{{{4, alongX, constant(0)}},
                 {{3, alongY, [](double x, double, double t) { return t * (3 - 8 * x); }},
                  {3, alongX, constant(shear)}},
                 {}});
  model.bodies.emplace_back("lower", crissCrossMesh({{0, -1}, {1, 0}, 3, 3}), std::move(material),
                            Conditions{{{4, alongX, constant(0)}, {1, alongY, constant(0)}}, {}, {}});
  addInterface(model, {{0, 1}, {1, 3}, CouplingKind::mortar});
  return model;
}

/// The tangent of a body over its equations.
Matrix tangentOf(const Body& body, const Matrix& moduli) {
  std::vector<double> values;
  body.tangent(moduli, values);
  return denseOf(body.pattern(), values);
}

/// The rows of C over the equations of a body.
Matrix rowsOf(const Body& body, const ConstraintRows& C) {
  Matrix rows(C.rows(), body.freeDofs());
  const Matrix dense(C);
  for (Eigen::Index i = 0; i < dense.rows(); ++i)
    rows.row(i) = body.gather(dense.row(i).transpose()).transpose();
  return rows;
}

TEST(StepSystem, linearSolveHoldsTheLawEquilibriumAndContact) {
  const Model model = squares(perzynaMaterial({100, 0.3}, {10, 0.05, Projection::elasticity}));
  StepSystem system(model, {});
  const State state0 = initialState(model);
  const StepData data{1, 0.1, {}};
  const Step step = system.step(state0, data);
  Iterate iterate = startingIterate(state0);
  StepOutcome outcome;
  bool opened = false;
  for (int i = 0; i < 2; ++i) {  // the second from stresses beyond yield
    const auto linearised = system.linearise(step, iterate, data.weight, false);
    const auto factorised = linearised.factorise(outcome);
    ASSERT_TRUE(factorised);
    StepSystem::Condensed condensed = factorised->condense(step, iterate);
    const ContactSolution contact = condensed.solveContact();
    const Iterate before = iterate;
    ASSERT_TRUE(std::move(condensed).expand(contact, iterate, outcome));
    std::vector<Vector> residual;
    for (int b : {0, 1}) {
      const Body& body = model.bodies[b];
      const Linearisation& law = linearised.law(b);
      const Vector d = iterate.bodies[b].increment.minus(before.bodies[b].increment);
      Matrix stress = law.predictor;
      body.addStressOf(d, law, stress, 0, body.points());
      EXPECT_LE((iterate.bodies[b].stress - stress).cwiseAbs().maxCoeff(), rounding);
      const Vector predicted = body.gather(step.loads[b] - body.internalForce(law.predictor));
      const ContactInterface& interface = model.interfaces[0];
      const Matrix C = rowsOf(body, b == 0 ? interface.C1() : interface.C2());
      // K d + C' p = F - sum |T| B' predictor
      const Vector balance =
          tangentOf(body, law.moduli) * body.gather(d) + C.transpose() * iterate.contactForce[0] - predicted;
      EXPECT_LE(balance.cwiseAbs().maxCoeff(), rounding * step.loads[0].cwiseAbs().maxCoeff())
          << "body " << b;
    }
    const Vector gap = gaps(model, state0.gap, iterate)[0];
    const Vector& p = iterate.contactForce[0];
    for (Eigen::Index k = 0; k < p.size(); ++k) {
      EXPECT_LE(gap[k], rounding);
      EXPECT_GE(p[k], 0);
      EXPECT_LE(std::abs(p[k] * gap[k]), rounding);
    }
    EXPECT_GT(p.maxCoeff(), 0);
    opened = opened || gap.minCoeff() < 0;
  }
  EXPECT_TRUE(opened);
}

/// A cube on rollers under a pressure that turns along x.
Model cube(std::shared_ptr<const Material> material) {
  Model model;
  const auto zero = [](const SpacePoint&, double) { return 0.0; };
  model.bodies.emplace_back(
      "cube", cuboidMesh({{0, 0, 0}, {1, 1, 1}, {2, 2, 2}}), std::move(material),
      Conditions{{{4, alongX, zero}, {5, alongY, zero}, {1, alongZ, zero}},
                 {{3, alongZ, [](const SpacePoint& x, double t) { return t * (3 - 8 * x.x()); }}}},
      1);
  return model;
}

// Laws with hidden variables too: their row of the stress follows strains and errors as the others do.
TEST(StepSystem, responseIsTheDerivativeOfTheSolution) {
  constexpr double h = 1e-6;
  constexpr Elasticity elasticity{100, 0.3};
  Overstress hardening;
  hardening.setViscosity(10);
  hardening.yieldStress = 0.05;
  hardening.isotropicHardening = 20;
  for (const Model& model : {squares(perzynaMaterial(elasticity, {10, 0.05, Projection::frobenius})),
                             squares(overstressMaterial(elasticity, hardening, Plane::strain)),
                             cube(overstressMaterial(elasticity, hardening, Plane::none))}) {
    SCOPED_TRACE(model.bodies[0].name());
    StepSystem system(model, {});
    const State state0 = initialState(model);
    std::vector<Matrix> error;
    for (size_t b = 0; b < model.bodies.size(); ++b)
      error.push_back(Matrix::NullaryExpr(state0.bodies[b].stress.rows(), state0.bodies[b].stress.cols(),
                                          [](Eigen::Index i, Eigen::Index j) {
                                            return 1e-3 * std::sin(1.0 + static_cast<double>(i + 3 * j));
                                          }));
    const auto solved = [&](double factor) {
      std::vector<Matrix> shift;
      for (const Matrix& e : error) shift.push_back(factor * e);
      Iterate iterate = startingIterate(state0);
      EXPECT_TRUE(solveStep(system, state0, {1, 0.1, shift}, iterate).converged());
      return iterate;
    };
    const Iterate ahead = solved(h);
    const Iterate behind = solved(-h);
    const Iterate middle = solved(0);
    const std::vector<Response> response = system.respond(error, middle);
    for (size_t b = 0; b < model.bodies.size(); ++b) {
      const Matrix difference = (ahead.bodies[b].stress - behind.bodies[b].stress) / (2 * h);
      for (Eigen::Index row = 0; row < difference.rows(); ++row)
        EXPECT_LE((response[b].stress - difference).row(row).cwiseAbs().maxCoeff(),
                  1e-4 * difference.row(row).cwiseAbs().maxCoeff())
            << row;
      const Vector moved = ahead.bodies[b].increment.minus(behind.bodies[b].increment) / (2 * h);
      EXPECT_LE((response[b].displacement - moved).cwiseAbs().maxCoeff(), 1e-4 * moved.cwiseAbs().maxCoeff());
    }
  }
}

TEST(StepSystem, aStepThatIsNotSolvedHasItsReason) {
  const auto elastic = elasticMaterial({100, 0.3});
  const State state0 = initialState(squares(elastic));
  {
    const Model model = squares(elastic);
    SolverOptions options;
    options.maxIterations = 0;
    StepSystem system(model, options);
    Iterate iterate = startingIterate(state0);
    const StepOutcome outcome = solveStep(system, state0, {1, 1, {}}, iterate);
    EXPECT_EQ(outcome.reason, Reason::unconverged);
    EXPECT_FALSE(outcome.detail.empty());
  }
  {
    Model model = squares(elastic);
    model.bodies[0] = Body("upper", crissCrossMesh({{0, 0}, {1, 1}, 2, 2}), elastic,
                           {{{4, alongX, constant(0)}}, {{3, alongY, constant(1)}}, {}});
    StepSystem system(model, {});
    Iterate iterate = startingIterate(state0);
    const StepOutcome outcome = solveStep(system, state0, {1, 1, {}}, iterate);
    EXPECT_TRUE(outcome.unheld());
    EXPECT_NE(outcome.detail.find("body upper: translation"), std::string::npos) << outcome.detail;
  }
}

TEST(StepSystem, aStepThatCannotEvenBeginEnds) {
  Model model;
  model.bodies.emplace_back(
      "square", crissCrossMesh({{0, 0}, {1, 1}, 2, 2}),
      perzynaMaterial({3e11, 0.3}, {10, 0.05, Projection::elasticity}),
      Conditions{{{4, alongX, constant(0)}, {1, alongY, constant(0)}, {3, alongY, constant(NAN)}}, {}, {}});
  const State state0 = initialState(model);
  StepSystem system(model, {});
  Iterate iterate = startingIterate(state0);
  const StepOutcome outcome = solveStep(system, state0, {1, 1, {}}, iterate, Effort::all);
  EXPECT_EQ(outcome.reason, Reason::unconverged);
}

TEST(StepSystem, restIsFoundOnlyWhereNothingChanges) {
  const Model model = squares(elasticMaterial({100, 0.3}));
  StepSystem system(model, {});
  State state = initialState(model);
  march(model, state, {.end = 1, .steps = 1}, {}, [](const State&, const StepReport&) {});
  Iterate iterate;
  const StepData same{state.time, 0.1, {}};
  EXPECT_TRUE(rest(system, system.step(state, same), iterate).converged());
  const StepData later{state.time + 1, 0.1, {}};
  EXPECT_FALSE(rest(system, system.step(state, later), iterate).converged());
}

}  // namespace mortier::step_system_test
