// Plane strain through contact on meshes that do not match: the compression of two blocks against its
// ordinary differential equation, with every scheme and coupling; initial stress, threads.
#include <gtest/gtest.h>

#include <array>
#include <iostream>
#include <numbers>
#include <string>

#include "material/deviatoric.h"
#include "theory/scenes.h"
#include "time/initial_balance.h"

namespace mortier::plane_strain_contact_test {

using namespace scenes;

constexpr Elasticity blockElasticity{100, 0.3};
constexpr Viscoplasticity blockLaw{1, 1};

/// Sides free, -10 t on the top: s11 = 0, s22 = -10 t, and eps33 = 0 says how s33 follows.
struct Compressed {
  double s33 = 0;
  double eps22 = 0;
  double eps11 = 0;
};

/// First yield, elastic until then: vM^2 = (1 - nu + nu^2) s22^2 [s].
double firstYield() {
  const double nu = blockElasticity.poisson;
  return blockLaw.yieldStress / (10 * std::sqrt(1 - nu + nu * nu));
}

/// By the classical Runge-Kutta method, far finer than what is compared.
Compressed exactCompression(double end) {
  const auto [E, nu] = std::pair(blockElasticity.young, blockElasticity.poisson);
  const auto rates = [E = E, nu = nu](double t, const Compressed& now) {
    const double s22 = -10 * t;
    const double mises = std::sqrt(s22 * s22 + now.s33 * now.s33 - s22 * now.s33);
    const double flow =
        mises > blockLaw.yieldStress ? (1 - blockLaw.yieldStress / mises) / (2 * blockLaw.viscosity) : 0;
    const double third = (s22 + now.s33) / 3;
    Compressed rate;
    rate.s33 = nu * -10 - E * flow * (now.s33 - third);
    rate.eps22 = (-10 - nu * rate.s33) / E + flow * (s22 - third);
    rate.eps11 = -nu * (-10 + rate.s33) / E - flow * third;
    return rate;
  };
  const auto moved = [](const Compressed& from, const Compressed& rate, double k) {
    return Compressed{from.s33 + k * rate.s33, from.eps22 + k * rate.eps22, from.eps11 + k * rate.eps11};
  };
  const double yield = firstYield();
  Compressed now{-nu * 10 * yield, (-10 + nu * nu * 10) * yield / E, nu * (1 + nu) * 10 * yield / E};
  constexpr int steps = 20000;
  const double k = (end - yield) / steps;
  for (int i = 0; i < steps; ++i) {
    const double t = yield + i * k;
    const Compressed a = rates(t, now);
    const Compressed b = rates(t + k / 2, moved(now, a, k / 2));
    const Compressed c = rates(t + k / 2, moved(now, b, k / 2));
    const Compressed d = rates(t + k, moved(now, c, k));
    now = moved(moved(moved(moved(now, a, k / 6), b, k / 3), c, k / 3), d, k / 6);
  }
  return now;
}

std::shared_ptr<const Material> blockMaterial() {
  return perzynaMaterial(blockElasticity, blockLaw, Plane::strain);
}

double topOf(const Model& model, const State& state) {
  return displacementRange(model.bodies[0], state.bodies[0], 1, [](const Point& x) { return x.y() == 1; })
      .mean();
}

// First yield falls on a step: within one it would cost Crank-Nicolson an error of its own, up and down with
// the steps.
TEST(PlaneStrainContact, schemesHaveTheirOrders) {
  const double end = 8 * firstYield();
  const Compressed exact = exactCompression(end);
  for (const auto& [scheme, order] :
       {std::pair(Scheme::backwardEuler, 1.0), std::pair(Scheme::crankNicolson, 2.0),
        std::pair(Scheme::sdirk2, 2.0)}) {
    std::vector<double> k;
    std::vector<double> errors;
    std::vector<double> s33Errors;
    for (const int steps : {80, 160, 320, 640}) {
      const Model model = compression(3, 4, blockMaterial(), CouplingKind::mortar, upperBody);
      State state = initialState(model);
      const RunReport report = march(model, state, {.end = end, .steps = steps, .scheme = scheme}, {},
                                     [](const State&, const StepReport&) {});
      ASSERT_EQ(report.status, Status::converged) << report.reason;
      k.push_back(end / steps);
      errors.push_back(std::abs(topOf(model, state) / (2 * exact.eps22) - 1));
      double worst = 0;
      for (const BodyState& body : state.bodies) {
        const Eigen::Vector3d s = fromCartesian({0, -10 * end, 0});
        EXPECT_LE((body.stress.topRows<3>().colwise() - s).cwiseAbs().maxCoeff(), 1e-10);
        EXPECT_LE((body.stress.row(3).array() - body.stress(3, 0)).abs().maxCoeff(), 1e-10);
        worst = std::max(worst, std::abs(body.stress(3, 0) - exact.s33));
        // eps33 = 0, and the volume of what flows is kept.
        Matrix elastic;
        model.bodies[0].material().elasticStrain(body.stress, elastic);
        EXPECT_LE((elastic.row(3) + body.viscoplasticStrain.row(3)).cwiseAbs().maxCoeff(), 1e-12);
        EXPECT_LE(
            std::abs(std::numbers::sqrt2 * body.viscoplasticStrain(0, 0) + body.viscoplasticStrain(3, 0)),
            1e-12);
      }
      s33Errors.push_back(worst);
      EXPECT_LE(interpenetration(model, state), 1e-13);
    }
    std::cout << "scheme " << static_cast<int>(scheme) << ": order " << fittedOrder(k, errors)
              << " (u2 on top), errors";
    for (const double error : errors) std::cout << " " << error;
    std::cout << "; s33 at the end within " << s33Errors.back() << " of " << exact.s33 << "\n";
    EXPECT_NEAR(fittedOrder(k, errors), order, 0.15);
    EXPECT_LE(s33Errors.back(), order == 1 ? 1e-2 : 1e-3);
  }
}

TEST(PlaneStrainContact, stepsChosenByTheirErrorMeetTheTolerance) {
  const Compressed exact = exactCompression(1);
  for (const double tolerance : {1e-2, 1e-3, 1e-4}) {
    const Model model = compression(3, 4, blockMaterial(), CouplingKind::mortar, upperBody);
    State state = initialState(model);
    const RunReport report =
        march(model, state, {.end = 1, .steps = 0, .scheme = Scheme::sdirk2, .tolerance = tolerance}, {},
              [](const State&, const StepReport&) {});
    ASSERT_EQ(report.status, Status::converged) << report.reason;
    const double error = std::abs(topOf(model, state) / (2 * exact.eps22) - 1);
    std::cout << "tolerance " << tolerance << ": " << report.steps << " steps, error " << error << "\n";
    EXPECT_LE(error, 2 * tolerance);
    EXPECT_LE(report.steps, 2 + 1 / std::cbrt(tolerance));  // no more caution than the tolerance asks
  }
}

// Where interpolation makes the stress uneven, its flow is harder: the note's stiff data, both couplings and
// sides.
TEST(PlaneStrainContact, stiffDataAreSolvedWithBothCouplings) {
  for (const CouplingKind coupling : {CouplingKind::mortar, CouplingKind::interpolation})
    for (const int nonmortar : {upperBody, lowerBody})
      for (const int steps : {7, 20}) {
        const Model model =
            compression(6, 16, perzynaMaterial(noteElasticity, {10, 1}, Plane::strain), coupling, nonmortar);
        const auto [state, report] = run(model, 1, steps);
        ASSERT_EQ(report.status, Status::converged) << report.reason;
        EXPECT_LE(report.worst.materialResidual, 1e-10);
        EXPECT_LE(report.worst.forceBalance, 1e-11);
        const Range mises = vonMisesRange(state);
        std::cout << (coupling == CouplingKind::mortar ? "mortar" : "interpolation") << ", " << steps
                  << " steps: " << report.iterations << " linear solves, von Mises " << mises.min << " to "
                  << mises.max << "\n";
        // s33 goes to s22/2, von Mises to sqrt(3)/2 of 10.
        if (coupling == CouplingKind::mortar) {
          EXPECT_LE(mises.distance(std::sqrt(75)), 1e-6);
        }
      }
}

// While nothing flows the factor of elasticity serves every step.
TEST(PlaneStrainContact, oneFactorServesWhileNothingFlows) {
  const Model model = compression(3, 5, perzynaMaterial({100, 0.3}, {1, 1000}, Plane::strain),
                                  CouplingKind::interpolation, upperBody);
  const Result result = run(model, 1, 6);
  ASSERT_EQ(result.report.status, Status::converged) << result.report.reason;
  EXPECT_EQ(result.report.factorisations, 2);
}

// Few steps that pass yield, the coarse side nonmortar: no step is cut.
TEST(PlaneStrainContact, hardStepsAreFollowedAlongThePath) {
  const Model model = compression(6, 16, perzynaMaterial(noteElasticity, {10, 1}, Plane::strain),
                                  CouplingKind::interpolation, lowerBody);
  int hard = 0;
  for (const int steps : {3, 4, 5, 9, 11}) {
    const Result result = run(model, 1, steps);
    ASSERT_EQ(result.report.status, Status::converged) << steps << ": " << result.report.reason;
    for (const auto& [method, count] : result.report.rungs) {
      if (method == "interior-point") hard += count;
      EXPECT_NE(method, "cut");
    }
  }
  std::cout << hard << " steps were followed along the path\n";
}

// An initial stress: s33 is what is given, elsewhere nu (s11 + s22); in equilibrium nothing moves.
TEST(PlaneStrainContact, initialStressAcrossThePlaneIsGivenOrElastic) {
  Conditions conditions{{{left, 0, constant(0)}, {bottom, 1, constant(0)}}, {{top, 1, constant(-2)}}, {}};
  conditions.initialStresses = {{1, {}, constant(-2)}, {3, 7, constant(-1.5)}};
  TriangleMesh mesh = square(0, 4);
  for (size_t t = 0; t < mesh.triangles.size(); ++t) mesh.regions[t] = t % 3 == 0 ? 7 : 8;
  Model model;
  model.bodies.emplace_back("block", mesh, elasticMaterial({100, 0.3}, Plane::strain), conditions);
  const Matrix stress = model.bodies[0].initialStress();
  for (size_t t = 0; t < mesh.triangles.size(); ++t)
    EXPECT_NEAR(stress(3, static_cast<Eigen::Index>(t)), t % 3 == 0 ? -1.5 : -0.6, 1e-15);
  State state = initialState(model);
  EXPECT_LE(balanceInitialStress(model, state, {}), 1e-13);
  EXPECT_LE(state.bodies[0].displacement.cwiseAbs().maxCoeff(), 1e-15);
  EXPECT_LE((state.bodies[0].stress - stress).cwiseAbs().maxCoeff(), 1e-13);
  const RunReport report =
      march(model, state, {.end = 1, .steps = 2}, {}, [](const State&, const StepReport&) {});
  EXPECT_EQ(report.status, Status::converged);
  EXPECT_LE(state.bodies[0].displacement.cwiseAbs().maxCoeff(), 1e-15);
}

TEST(PlaneStrainContact, threadsChangeNoBit) {
  // Enough triangles that threads are used.
  const Model model = compression(61, 67, perzynaMaterial(noteElasticity, {10, 1}, Plane::strain),
                                  CouplingKind::interpolation, upperBody);
  SolverOptions options;
  options.threads = 1;
  const Result one = run(model, 0.3, 2, options);
  options.threads = 3;
  const Result three = run(model, 0.3, 2, options);
  ASSERT_EQ(one.report.status, Status::converged) << one.report.reason;
  EXPECT_EQ(one.report.iterations, three.report.iterations);
  for (size_t b = 0; b < 2; ++b) {
    EXPECT_TRUE(one.state.bodies[b].stress == three.state.bodies[b].stress);
    EXPECT_TRUE(one.state.bodies[b].displacement == three.state.bodies[b].displacement);
  }
}

}  // namespace mortier::plane_strain_contact_test
