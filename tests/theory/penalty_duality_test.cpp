// The note's own algorithm against the mixed Newton: two ways to one solution.
#include <gtest/gtest.h>

#include <iostream>

#include "material/parts.h"
#include "theory/hard_cases.h"

namespace mortier::penalty_duality_test {

using namespace scenes;

constexpr Projection allProjections[] = {Projection::elasticity, Projection::frobenius,
                                         Projection::compliance};

SolverOptions penaltyDuality() {
  SolverOptions options;
  options.method = Method::penaltyDuality;
  options.maxIterations = defaultIterations(options.method);
  return options;
}

Model note(Projection projection, CouplingKind coupling, int nonmortar, double viscosity = 10) {
  Viscoplasticity law = noteLaw(projection);
  law.viscosity = viscosity;
  return compression(6, 16, perzynaMaterial(noteElasticity, law), coupling, nonmortar);
}

/// Largest difference of displacements and stresses, over the largest value of each.
double difference(const State& a, const State& b) {
  double du = 0;
  double ds = 0;
  double u = 0;
  double s = 0;
  for (size_t i = 0; i < a.bodies.size(); ++i) {
    du = std::max(du, (a.bodies[i].displacement - b.bodies[i].displacement).cwiseAbs().maxCoeff());
    ds = std::max(ds, (a.bodies[i].stress - b.bodies[i].stress).cwiseAbs().maxCoeff());
    u = std::max(u, b.bodies[i].displacement.cwiseAbs().maxCoeff());
    s = std::max(s, b.bodies[i].stress.cwiseAbs().maxCoeff());
  }
  return std::max(du / u, ds / s);
}

void expectSameAsNewton(const Model& model, int steps) {
  constexpr double asked = 1e-8;  // measured: 2e-11
  constexpr double complementarity =
      1e-12;  // it is reached by iteration, not by a set that is exact; measured: 2e-13
  const Result newton = run(model, 1, steps);
  const Result duality = run(model, 1, steps, penaltyDuality());
  ASSERT_EQ(newton.report.status, Status::converged) << newton.report.reason;
  ASSERT_EQ(duality.report.status, Status::converged) << duality.report.reason;
  EXPECT_EQ(duality.report.steps, steps);
  EXPECT_EQ(duality.report.rejected, 0) << "cut steps have another answer";
  EXPECT_LE(difference(duality.state, newton.state), asked);
  EXPECT_LE(duality.report.worst.forceBalance, hardcases::forceBalanceLimit);
  EXPECT_LE(duality.report.worst.complementarity, complementarity);
  EXPECT_LE(duality.report.worst.materialResidual, hardcases::materialResidualLimit);
  std::cout << "N = " << steps << ": Newton " << newton.report.iterations << ", penalty-duality "
            << duality.report.iterations << " iterations, difference "
            << difference(duality.state, newton.state) << "\n";
}

// The note's data: theta e = 2e8 at N = 10. The first of its steps ends on first yield.
TEST(PenaltyDuality, mortarGivesNewtonsAnswerOnTheNotesTest) {
  for (const Projection projection : allProjections)
    for (const int nonmortar : {upperBody, lowerBody})
      expectSameAsNewton(note(projection, CouplingKind::mortar, nonmortar), 10);
}

// Steps so long that both bodies flow at the end of the first: 4.7 times 0.25 exceeds the yield stress.
TEST(PenaltyDuality, interpolationGivesNewtonsAnswerWhereBodiesFlow) {
  for (const Projection projection : allProjections)
    for (const int nonmortar : {upperBody, lowerBody})
      expectSameAsNewton(note(projection, CouplingKind::interpolation, nonmortar), 4);
  const auto strain = perzynaMaterial({100, 0.3}, {1, 1}, Plane::strain);
  expectSameAsNewton(compression(3, 5, strain, CouplingKind::interpolation, upperBody), 5);
}

// theta e = 1e4: steps in which one part flows and another does not.
TEST(PenaltyDuality, interpolationPassesYieldInAMoreViscousBody) {
  const double viscosity = 0.1 * noteElasticity.moduli()[0] / (2 * 1e4);
  for (const Projection projection : {Projection::elasticity, Projection::frobenius})
    expectSameAsNewton(note(projection, CouplingKind::interpolation, upperBody, viscosity), 10);
}

TEST(PenaltyDuality, elasticBodiesDifferOnlyByTheContactMultipliers) {
  for (const CouplingKind coupling : {CouplingKind::mortar, CouplingKind::interpolation})
    expectSameAsNewton(compression(6, 16, elasticMaterial(noteElasticity), coupling, upperBody), 2);
}

/// Squares of the note's test whose left part is elastic and three times as stiff, on a right part that
/// flows.
Body mixed(const std::string& name, double lowerY, int cells, Projection projection, Conditions conditions) {
  const auto& [young, poisson] = noteElasticity;
  Viscoplasticity law = noteLaw(projection);
  law.viscosity = 0.25 * noteElasticity.moduli()[0] / (2 * 1e2);  // theta e = 100 at N = 4
  TriangleMesh mesh = square(lowerY, cells);
  std::vector<int> part;
  for (const auto& [a, b, c] : mesh.triangles)
    part.push_back(mesh.vertices[a].x() + mesh.vertices[b].x() + mesh.vertices[c].x() < 1.2 ? 0 : 1);
  return {
      name, std::move(mesh),
      materialOfParts({elasticMaterial({3 * young, poisson}), perzynaMaterial({young, poisson}, law)}, part),
      std::move(conditions)};
}

// Stiff elastic regions beside regions that flow, in both bodies; the load leaves the one for the other.
TEST(PenaltyDuality, regionsOfTwoMaterialsGiveNewtonsAnswer) {
  const Function load = [](double, double, double t) { return -10 * t; };
  for (const Projection projection : allProjections)
    for (const int nonmortar : {upperBody, lowerBody}) {
      const Model model = contactModel(
          mixed("upper", 0, 5, projection, {{{left, 0, constant(0)}}, {{top, 1, load}}, {}}),
          mixed("lower", -1, 8, projection, {{{left, 0, constant(0)}, {bottom, 1, constant(0)}}, {}, {}}),
          CouplingKind::mortar, nonmortar);
      expectSameAsNewton(model, 4);
      const State state = run(model, 1, 4, penaltyDuality()).state;
      for (const BodyState& body : state.bodies) {
        double most = 0;
        double least = INFINITY;
        for (Eigen::Index i = 0; i < body.viscoplasticStrain.cols(); ++i) {
          most = std::max(most, body.viscoplasticStrain.col(i).norm());
          least = std::min(least, body.viscoplasticStrain.col(i).norm());
        }
        EXPECT_GT(most, 1 / noteElasticity.young);  // the strain of first yield
        EXPECT_LE(least, 1e-12 * most);             // rounding
      }
    }
}

// An edge that lifts off: nodes change sides between iterations.
TEST(PenaltyDuality, contactThatOpensInPartGivesNewtonsAnswer) {
  for (const CouplingKind coupling : {CouplingKind::mortar, CouplingKind::interpolation}) {
    const Function load = [](double x, double, double t) { return x < 0.47 ? -10 * t : 8 * t; };
    Body upper("upper", square(0, 6), elasticMaterial(noteElasticity),
               {{{left, 0, constant(0)}}, {{top, 1, load}}, {}});
    Body lower("lower", square(-1, 16), elasticMaterial({3e10, 0.3}),
               {{{bottom, 0, constant(0)}, {bottom, 1, constant(0)}}, {}, {}});
    const Model model = contactModel(std::move(upper), std::move(lower), coupling, upperBody);
    expectSameAsNewton(model, 1);
    const Result duality = run(model, 1, 1, penaltyDuality());
    const Vector& p = duality.state.contactForce[0];
    EXPECT_TRUE((p.array() == 0).any() && (p.array() > 0).any()) << p.transpose();
  }
}

// A decade of accuracy costs the same number of iterations, however many there were before.
TEST(PenaltyDuality, convergesLinearly) {
  std::vector<double> iterations;
  for (const double tolerance : {1e-4, 1e-6, 1e-8, 1e-10}) {
    SolverOptions options = penaltyDuality();
    options.tolerance = tolerance;
    const Result result = run(note(Projection::frobenius, CouplingKind::mortar, upperBody), 1, 1, options);
    ASSERT_EQ(result.report.status, Status::converged);
    iterations.push_back(result.report.iterations);
  }
  const double first = iterations[1] - iterations[0];
  for (size_t i = 1; i < iterations.size(); ++i) EXPECT_NEAR(iterations[i] - iterations[i - 1], first, 2);
  EXPECT_GE(first, 2);
}

TEST(PenaltyDuality, parametersHaveNoUnits) {
  std::vector<int> iterations;
  for (const double scale : {1.0, 1048576.0, 1.0 / 1024}) {
    hardcases::Compression scene;
    scene.length = 1 / scale;
    scene.stress = scale * scale;
    scene.time = 8 * scale;
    scene.coupling = CouplingKind::interpolation;
    iterations.push_back(run(scene.model(), scene.time, 4, penaltyDuality()).report.iterations);
  }
  EXPECT_EQ(iterations[1], iterations[0]);
  EXPECT_EQ(iterations[2], iterations[0]);
}

// theta e = 2e8, some triangles on the yield surface, some inside: the rate is 1 - O((theta e)^(-1/2)). The
// step is given up, and says so.
TEST(PenaltyDuality, givesUpWhereItIsTooSlow) {
  SolverOptions options = penaltyDuality();
  options.maxIterations = 100;
  const Result result =
      run(note(Projection::elasticity, CouplingKind::interpolation, upperBody), 1, 10, options);
  EXPECT_EQ(result.report.status, Status::failed);
  EXPECT_NE(result.report.reason.find("penalty-duality method did not converge in 100 iterations"),
            std::string::npos)
      << result.report.reason;
}

TEST(PenaltyDuality, namesTheBodyThatContactCannotHold) {
  Body upper("upper", square(0, 4), elasticMaterial(noteElasticity),
             {{{left, 0, constant(0)}}, {{top, 1, [](double, double, double t) { return 10 * t; }}}, {}});
  Body lower("lower", square(-1, 5), elasticMaterial(noteElasticity),
             {{{bottom, 0, constant(0)}, {bottom, 1, constant(0)}}, {}, {}});
  const Model model = contactModel(std::move(upper), std::move(lower), CouplingKind::mortar, upperBody);
  const Result result = run(model, 1, 1, penaltyDuality());
  EXPECT_EQ(result.report.status, Status::unheld);
  EXPECT_NE(result.report.reason.find("body upper"), std::string::npos) << result.report.reason;
}

}  // namespace mortier::penalty_duality_test
