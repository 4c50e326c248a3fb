#include <gtest/gtest.h>

#include <cmath>
#include <random>

#include "unit/one_point.h"

namespace mortier::perzyna_closed_forms_test {

/// Viscoplastic strain under a stress that grows to 10 t along a direction: N backward Euler steps, each
/// begun with the strain that must lead to that stress.
Vector3d rampStrain(Projection projection, const Vector3d& direction, int steps) {
  const auto material = perzynaMaterial({3e11, 0.3}, {10, 1, projection});
  Vector3d s0 = Vector3d::Zero();
  Vector3d viscoplastic = Vector3d::Zero();
  for (int n = 1; n <= steps; ++n) {
    const Vector3d target = 10.0 * n / steps * direction;
    Matrix rate;
    Matrix elastic;
    material->viscoplasticRate(target, rate);
    material->elasticStrain(target - s0, elastic);
    const Vector3d s = solve(*material, 1.0 / steps, s0, elastic + rate / steps, 0.9 * target);
    // A strain of order 0.1 holds the elastic part, order 1e-12, to 1e-5 of itself; beyond yield that hardly
    // matters.
    EXPECT_LE((s - target).norm(), n > steps / 5 ? 1e-12 : 1e-9) << n;
    viscoplastic += rate / steps;
    s0 = target;
  }
  return viscoplastic;
}

TEST(PerzynaClosedForms, rampsFollowTheirClosedForms) {
  constexpr int steps = 2000;
  const Vector3d equibiaxial = fromCartesian({1, 1, 0});
  const Vector3d shear = fromCartesian({0, 0, 1});
  // Backward Euler adds half a step of the final rate, (10 - threshold)/20, and beyond that a kink of order
  // 1/steps^2.
  constexpr double kink = 10.0 / 20 / steps / steps;
  for (const Projection projection : projections) {
    EXPECT_NEAR(toCartesian(rampStrain(projection, equibiaxial, steps))[0], 0.2025 + 9.0 / 20 / 2 / steps,
                kink);
    EXPECT_NEAR(toCartesian(rampStrain(projection, shear, steps))[2],
                0.2219658198738 + (10 - 1 / std::sqrt(3.0)) / 20 / 2 / steps, kink);
  }
}

// Strain held, a stress of 2 falls towards sigma_Y = 1: sigma_Y + (2 - sigma_Y) (1 + rate k)^-N by backward
// Euler, exp(-2) in the limit. Errors as tabulated for rate 2, T = 1.
TEST(PerzynaClosedForms, relaxationFollowsItsClosedForm) {
  const double errors[][2] = {
      {10, 2.617e-2}, {20, 1.331e-2}, {40, 6.710e-3}, {80, 3.369e-3}, {160, 1.688e-3}};
  const double nu = 0.3;
  for (const Projection projection : projections)
    for (const bool shear : {false, true}) {
      // Rates E/(2 lambda (1 - nu)) and, in shear, E/(2 lambda (1 + nu)), both made 2.
      const double young = 2 * 2 * 10 * (shear ? 1 + nu : 1 - nu);
      const auto material = perzynaMaterial({young, nu}, {10, 1, projection});
      const Vector3d start = shear ? fromCartesian({0, 0, 2 / std::sqrt(3.0)}) : fromCartesian({2, 2, 0});
      for (const auto& [steps, error] : errors) {
        Vector3d s = start;
        for (int n = 0; n < static_cast<int>(steps); ++n)
          s = solve(*material, 1 / steps, s, Vector3d::Zero(), s);
        EXPECT_NEAR(vonMises(s), 1 + std::pow(1 + 2 / steps, -steps), 1e-13);
        EXPECT_NEAR(vonMises(s) - (1 + std::exp(-2.0)), error, 5e-4 * error);
      }
    }
}

// theta e = 1.5e8: one step lands on the yield surface.
// Uniaxial stress: the table of docs/scene.md. Towards yield the rate over that of the overstress is 2 (b_p +
// b_q)/(b_p + 3 b_q), lateral over axial flow (b_p - b_q)/(b_p + b_q).
TEST(PerzynaClosedForms, uniaxialFlowIsNotThatOfThreeDimensions) {
  struct Row {
    Projection projection;
    double overYield, rate, lateral;
  };
  const Row rows[] = {{Projection::frobenius, 1.2, 0.826, -0.445},
                      {Projection::frobenius, 2, 0.894, -0.296},
                      {Projection::elasticity, 1.2, 0.771, -0.643},
                      {Projection::elasticity, 2, 0.863, -0.459},
                      {Projection::compliance, 1.2, 0.911, -0.201},
                      {Projection::compliance, 5, 0.979, -0.052},
                      {Projection::frobenius, 1 + 1e-6, 0.8, -0.5},
                      {Projection::elasticity, 1 + 1e-6, 4.6 / 6.2, -1.6 / 2.3},
                      {Projection::compliance, 1 + 1e-6, 0.895, -0.235}};
  constexpr double printed = 5e-4;
  constexpr double viscosity = 10;
  for (const auto& [projection, stress, expected, lateral] : rows) {
    const auto material = perzynaMaterial({1e6, 0.3}, {viscosity, 1, projection});
    Matrix rate;
    material->viscoplasticRate(fromCartesian({stress, 0, 0}), rate);
    const Vector3d flow = toCartesian(rate.col(0));
    EXPECT_NEAR(flow[0] / ((stress - 1) / (2 * viscosity)), expected, printed);
    EXPECT_NEAR(flow[1] / flow[0], lateral, printed);
  }
}

TEST(PerzynaClosedForms, stiffStepLandsOnTheYieldSurface) {
  for (const Projection projection : projections) {
    const auto material = perzynaMaterial({3e11, 0.3}, {10, 1, projection});
    std::mt19937 random(17);
    for (int k = 0; k < 20; ++k) {
      const Vector3d s0 = randomStress(random, 2);
      EXPECT_NEAR(vonMises(solve(*material, 0.01, s0, Vector3d::Zero(), s0)), 1, 2e-8);
    }
  }
}

}  // namespace mortier::perzyna_closed_forms_test
