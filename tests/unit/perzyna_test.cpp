#include "material/perzyna.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <iostream>
#include <limits>
#include <random>
#include <string>

#include "base/error.h"
#include "unit/one_point.h"

namespace mortier::perzyna_test {

constexpr double epsilon = std::numeric_limits<double>::epsilon();

// H^-1 is the derivative of the solved stress with respect to the strain, however yielding is judged.
// One-sided differences of third order, so that stresses on the yield surface meet the tangent of its outer
// side.
TEST(Perzyna, tangentMatchesFiniteDifference) {
  constexpr Long h = 1e-5L;  // truncation h^3 = 1e-15, rounding 1e-19/h = 1e-14
  constexpr double differences = 1e-10;
  // The distance from the yield surface enters H; a double knows it to rounding only.
  constexpr double rounding = 2 * epsilon;
  double worst = 0;
  std::mt19937 random(7);
  for (const Projection projection : projections)
    for (const double nu : {0.3, -0.4, 0.49})
      for (const double thetaE : {1e-6, 1e-3, 1.0, 1e3, 1e8, 1e12})
        for (const double beyond : {0.0, 1e-6, 1e-2, 0.5, 10.0, 1e6}) {
          const Elasticity elasticity{3e11, nu};
          const double weight = 2 * 10 * thetaE / elasticity.moduli().maxCoeff();
          const Law law{elasticity, {10, 1, projection}, weight};
          const auto material = perzynaMaterial(law.elasticity, law.viscoplasticity);
          // On the surface: the first rounded stress that is not inside.
          Vector3d s = randomStress(random, 1 + beyond);
          while (law.multiplier(s.array().cast<Long>(), law.b()) == 0) s *= 1 + epsilon;
          const LongArray trial = law.trialOf(s.array().cast<Long>());
          const LongArray outward = s.array().cast<Long>() * law.e();
          // The step that ends at s.
          const Vector3d strain = ((trial - s.array().cast<Long>()) / law.e()).cast<double>().matrix();
          for (const bool anticipate : {false, true}) {
            const Eigen::Matrix3d H = linearise(*material, weight, s, strain, s, anticipate).moduli;
            for (int j = 0; j < 3; ++j) {
              const Long step = h * trial.abs().maxCoeff() * (outward[j] < 0 ? -1 : 1);
              const auto at = [&](int k) {
                LongArray t = trial;
                t[j] += k * step;
                return law.stress(t);
              };
              const LongArray derivative =
                  (-11 * at(0) + 18 * at(1) - 9 * at(2) + 2 * at(3)) / (6 * step) * law.e()[j];
              const Long difference = (derivative - H.col(j).array().cast<Long>()).abs().maxCoeff();
              const double error = static_cast<double>(difference) / H.cwiseAbs().maxCoeff();
              const double tolerance = differences + (beyond > 0 ? rounding / beyond : rounding * thetaE);
              ASSERT_LE(error, tolerance)
                  << "projection " << static_cast<int>(projection) << ", nu " << nu << ", theta e " << thetaE
                  << ", beyond by " << beyond << ", column " << j << (anticipate ? ", anticipated" : "");
              worst = std::max(worst, error / tolerance);
            }
          }
        }
  std::cout << "tangent against differences: at most " << worst << " of the tolerance\n";
}

TEST(Perzyna, elasticityIsPlaneStress) {
  constexpr double rounding = 4 * epsilon;
  const Elasticity elasticity{200, 0.3};
  for (const auto& material : {elasticMaterial(elasticity), perzynaMaterial(elasticity, {10, 1})}) {
    Matrix strain;
    material->elasticStrain(fromCartesian({0, 1, 0}), strain);
    EXPECT_LE((200 * toCartesian(strain) - Vector3d(-0.3, 1, 0)).norm(), rounding);
    material->elasticStrain(fromCartesian({0, 0, 1}), strain);
    EXPECT_LE((200 * toCartesian(strain) - Vector3d(0, 0, 1.3)).norm(), rounding);
  }
}

TEST(Perzyna, tangentIsElasticInsideTheYieldSurface) {
  const Elasticity elasticity{3e11, 0.3};
  std::mt19937 random(11);
  for (const Projection projection : projections) {
    const auto material = perzynaMaterial(elasticity, {10, 1, projection});
    for (const double size : {0.0, 1e-3, 0.5, 1 - 1e-9}) {
      const Vector3d s = randomStress(random, size);
      const Answer answer =
          linearise(*material, 0.01, Vector3d(0.1, 0.2, 0.3), Vector3d(1e-12, 2e-12, -1e-12), s);
      EXPECT_EQ(answer.moduli, Eigen::Matrix3d(elasticity.moduli().matrix().asDiagonal()));
      const Vector3d expected =
          Vector3d(0.1, 0.2, 0.3) + elasticity.moduli().matrix().cwiseProduct(Vector3d(1e-12, 2e-12, -1e-12));
      EXPECT_LE((answer.predictor - expected).norm(), 8 * epsilon);
    }
  }
}

// At one point Newton's method needs no safeguard; with yielding anticipated a handful of iterations do,
// whatever theta e.
TEST(Perzyna, newtonEndsAtTheSolvedStress) {
  constexpr double tolerance = 1e-12;  // relative; rounding, enlarged by the stiff steps of the plain method
  std::mt19937 random(3);
  const auto expectSolved = [&](Projection projection, double thetaE, bool anticipate, int iterations) {
    const Elasticity elasticity{100, 0.3};
    const double weight = 2 * 10 * thetaE / elasticity.moduli().maxCoeff();
    const Law law{elasticity, {10, 1, projection}, weight};
    const auto material = perzynaMaterial(law.elasticity, law.viscoplasticity);
    for (const double size : {0.02, 1.0, 100.0})
      for (int k = 0; k < 100; ++k) {
        const Vector3d s0 = randomStress(random, k % 2 == 0 ? 0.5 : 1.2);
        const Vector3d strain = randomStress(random, size);
        const LongArray trial = s0.array().cast<Long>() + law.e() * strain.array().cast<Long>();
        const Vector3d exact = law.stress(trial).cast<double>().matrix();
        const Vector3d s = solve(*material, weight, s0, strain, s0, anticipate, iterations);
        ASSERT_LE((s - exact).norm(), tolerance * exact.norm())
            << "projection " << static_cast<int>(projection) << ", theta e " << thetaE
            << (anticipate ? ", anticipated" : "");
      }
  };
  for (const Projection projection : projections) {
    for (const double thetaE : {1e-6, 1.0, 1e3, 1e8}) expectSolved(projection, thetaE, false, 16);
    for (const double thetaE : {1e-6, 1.0, 1e3, 1e8, 1e12}) expectSolved(projection, thetaE, true, 6);
  }
}

TEST(Perzyna, tangentIsSymmetricExactlyWhenItSaysSo) {
  constexpr double rounding = 4 * epsilon;
  constexpr double clearly = 1e-2;
  std::mt19937 random(5);
  for (const Projection projection : projections) {
    const auto material = perzynaMaterial({3e11, 0.3}, {10, 1, projection});
    double asymmetry = 0;
    for (int k = 0; k < 200; ++k) {
      const Vector3d s = randomStress(random, k % 2 == 0 ? 1.5 : 30);
      const Eigen::Matrix3d H = linearise(*material, 0.01, s, Vector3d::Zero(), s).moduli;
      asymmetry = std::max(asymmetry, (H - H.transpose()).cwiseAbs().maxCoeff() / H.cwiseAbs().maxCoeff());
    }
    if (material->symmetricTangent())
      EXPECT_LE(asymmetry, rounding);
    else
      EXPECT_GE(asymmetry, clearly);
  }
  EXPECT_TRUE(perzynaMaterial({1, 0.3}, {1, 1, Projection::frobenius})->symmetricTangent());
  EXPECT_TRUE(elasticMaterial({1, 0.3})->symmetricTangent());
}

TEST(Perzyna, wrongConstantsAreNamed) {
  const auto message = [](const Elasticity& elasticity, const Viscoplasticity& viscoplasticity) {
    try {
      perzynaMaterial(elasticity, viscoplasticity);
    } catch (const InputError& error) {
      return std::string(error.what());
    }
    return std::string();
  };
  EXPECT_EQ(message({1, 0.3}, {1, 1}), "");
  EXPECT_EQ(message({1, 0.5}, {1, 1}), "poisson = 0.5, expected -1 < poisson < 0.5");
  EXPECT_EQ(message({1, -1}, {1, 1}), "poisson = -1, expected -1 < poisson < 0.5");
  EXPECT_EQ(message({0, 0.3}, {1, 1}), "young = 0, expected young > 0 [Pa]");
  EXPECT_EQ(message({1, 0.3}, {0, 1}), "viscosity = 0, expected viscosity > 0 [Pa s]");
  EXPECT_EQ(message({1, 0.3}, {1, -2}), "yield_stress = -2, expected yield_stress > 0 [Pa]");
  EXPECT_NE(message({std::nan(""), 0.3}, {1, 1}), "");
  EXPECT_NE(message({1, 0.3}, {std::numeric_limits<double>::infinity(), 1}), "");
}

}  // namespace mortier::perzyna_test
