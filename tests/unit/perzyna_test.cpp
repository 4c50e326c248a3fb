#include "material/perzyna.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <iostream>
#include <limits>
#include <random>
#include <string>

#include "base/error.h"
#include "material/stress.h"

namespace mortier {
namespace {

using Eigen::Vector3d;
using Long = long double;
using LongArray = Eigen::Array<Long, 3, 1>;

constexpr double epsilon = std::numeric_limits<double>::epsilon();
constexpr Projection projections[] = {Projection::elasticity, Projection::frobenius, Projection::compliance};

/// The law at one point, in extended precision and solved for the stress: with the trial t = s0 + E strain,
///   P_i = t_i / (1 + m b_i (1 + theta e_i)),  s_i = P_i (1 + m b_i),  m the root of a . P^2 = sigma_Y^2.
struct Law {
  Elasticity elasticity;
  Viscoplasticity viscoplasticity;
  double weight = 0;

  [[nodiscard]] LongArray e() const { return elasticity.moduli().cast<Long>(); }
  [[nodiscard]] Long theta() const { return Long(weight) / (2 * Long(viscoplasticity.viscosity)); }
  [[nodiscard]] LongArray b() const {
    const LongArray a(0.5L, 1.5L, 1.5L);
    if (viscoplasticity.projection == Projection::elasticity) return a * e()[1] / e();
    if (viscoplasticity.projection == Projection::compliance) return a * e() / e()[1];
    return a;
  }

  /// The root m of |v / (1 + m c)| = sigma_Y, by bisection.
  [[nodiscard]] Long multiplier(const LongArray& v, const LongArray& c) const {
    const auto beyond = [&](Long m) {
      const LongArray P = v / (1 + m * c) / Long(viscoplasticity.yieldStress);
      return 0.5L * P[0] * P[0] + 1.5L * (P[1] * P[1] + P[2] * P[2]) > 1;
    };
    if (!beyond(0)) return 0;
    Long low = 0;
    Long high = 1e-20L;
    while (beyond(high)) high *= 16;
    for (int k = 0; k < 140; ++k) (beyond((low + high) / 2) ? low : high) = (low + high) / 2;
    return high;
  }

  [[nodiscard]] LongArray stress(const LongArray& trial) const {
    const LongArray c = b() * (1 + theta() * e());
    const Long m = multiplier(trial, c);
    return trial / (1 + m * c) * (1 + m * b());
  }

  /// The trial that leads to stress s.
  [[nodiscard]] LongArray trialOf(const LongArray& s) const {
    const Long m = multiplier(s, b());
    return s / (1 + m * b()) * (1 + m * b() * (1 + theta() * e()));
  }
};

struct Answer {
  Vector3d predictor;
  Eigen::Matrix3d moduli;
};

Answer linearise(const Material& material, double weight, const Vector3d& s0, const Vector3d& strain,
                 const Vector3d& s, bool anticipate = false) {
  Linearisation result{Matrix(3, 1), Matrix(9, 1)};
  const Matrix stress0 = s0;
  const Matrix strains = strain;
  const MaterialStep step{weight, stress0, strains, anticipate};
  material.linearise(step, Matrix(s), result, 0, 1);
  return {result.predictor.col(0), Eigen::Map<const Eigen::Matrix3d>(result.moduli.data())};
}

/// The stress at the end of a step with a given strain, by Newton's method from `s`.
Vector3d solve(const Material& material, double weight, const Vector3d& s0, const Vector3d& strain, Vector3d s,
               bool anticipate = false, int iterations = 60) {
  for (int k = 0; k < iterations; ++k) s = linearise(material, weight, s0, strain, s, anticipate).predictor;
  return s;
}

Vector3d randomStress(std::mt19937& random, double misesStress) {
  std::normal_distribution<double> normal;
  const Vector3d s(normal(random), normal(random), normal(random));
  return s * (misesStress / vonMises(s));
}

// H^-1 is the derivative of the solved stress with respect to the strain, however yielding is judged. One-sided
// differences of third order, so that stresses on the yield surface meet the tangent of its outer side.
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
              ASSERT_LE(error, tolerance) << "projection " << static_cast<int>(projection) << ", nu " << nu
                                          << ", theta e " << thetaE << ", beyond by " << beyond << ", column "
                                          << j << (anticipate ? ", anticipated" : "");
              worst = std::max(worst, error / tolerance);
            }
          }
        }
  std::cout << "tangent against differences: at most " << worst << " of the tolerance\n";
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

TEST(Perzyna, newtonEndsAtTheSolvedStress) {
  constexpr double tolerance = 1e-13;  // relative; rounding of a few operations
  std::mt19937 random(3);
  for (const Projection projection : projections)
    for (const double thetaE : {1e-6, 1.0, 1e3}) {
      const Elasticity elasticity{100, 0.3};
      const double weight = 2 * 10 * thetaE / elasticity.moduli().maxCoeff();
      const Law law{elasticity, {10, 1, projection}, weight};
      const auto material = perzynaMaterial(law.elasticity, law.viscoplasticity);
      for (int k = 0; k < 50; ++k) {
        const Vector3d s0 = randomStress(random, 1.2);
        const Vector3d strain = randomStress(random, 0.02);
        const LongArray trial = s0.array().cast<Long>() + law.e() * strain.array().cast<Long>();
        const Vector3d exact = law.stress(trial).cast<double>().matrix();
        const Vector3d s = solve(*material, weight, s0, strain, s0);
        ASSERT_LE((s - exact).norm(), tolerance * static_cast<double>(trial.abs().maxCoeff()))
            << "projection " << static_cast<int>(projection) << ", theta e " << thetaE;
      }
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

TEST(Perzyna, rampsFollowTheirClosedForms) {
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
TEST(Perzyna, relaxationFollowsItsClosedForm) {
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
TEST(Perzyna, stiffStepLandsOnTheYieldSurface) {
  for (const Projection projection : projections) {
    const auto material = perzynaMaterial({3e11, 0.3}, {10, 1, projection});
    std::mt19937 random(17);
    for (int k = 0; k < 20; ++k) {
      const Vector3d s0 = randomStress(random, 2);
      EXPECT_NEAR(vonMises(solve(*material, 0.01, s0, Vector3d::Zero(), s0)), 1, 2e-8);
    }
  }
}

TEST(Perzyna, unitsOfPowersOfTwoChangeNoBit) {
  std::mt19937 random(13);
  for (const Projection projection : projections)
    for (const double stress : {0x1p-37, 0x1p+20})
      for (const double time : {0x1p-11, 0x1p+17}) {
        const auto material = perzynaMaterial({3e11, 0.3}, {10, 1, projection});
        const auto scaled = perzynaMaterial({stress * 3e11, 0.3}, {stress * time * 10, stress, projection});
        const Vector3d s0 = randomStress(random, 1.5);
        const Vector3d strain = randomStress(random, 1e-3);
        for (const double size : {0.5, 1.0 + 1e-9, 7.0}) {
          const Vector3d s = randomStress(random, size);
          const Answer answer = linearise(*material, 0.01, s0, strain, s);
          const Answer other = linearise(*scaled, time * 0.01, stress * s0, strain, stress * s);
          EXPECT_EQ(other.predictor, stress * answer.predictor);
          EXPECT_EQ(other.moduli, stress * answer.moduli);
        }
      }
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

}  // namespace
}  // namespace mortier
