#include "material/deviatoric.h"

#include <gtest/gtest.h>

#include <Eigen/Cholesky>
#include <cmath>
#include <iostream>
#include <random>

#include "base/error.h"
#include "material/interior_path.h"
#include "material/stress.h"
#include "unit/plane_strain_point.h"

namespace mortier::plane_strain_test {

TEST(PlaneStrain, elasticityIsThatOfThreeDimensions) {
  const Elasticity elasticity{200, 0.3};
  const Tensors exact{elasticity, {}, 0};
  std::mt19937 random(1);
  for (const auto& material :
       {elasticMaterial(elasticity, Plane::strain), perzynaMaterial(elasticity, {10, 1e6}, Plane::strain)}) {
    EXPECT_EQ(material->components(), 4);
    const Vector4d zero = Vector4d::Zero();
    Vector4d strain = 0.01 * randomStress4(random, 1, 0.3);
    strain[3] = 0;  // plane strain
    const Vector4d s = lineariseAt(*material, 0.1, zero, strain, zero).predictor;
    EXPECT_LE((s - Tensors::vector(exact.stressOf(Tensors::tensor(strain)))).norm(), 16 * epsilon * s.norm());
    EXPECT_NEAR(s[3], 0.3 * std::numbers::sqrt2 * s[0], 16 * epsilon * s.norm());
    EXPECT_NEAR(material->outOfPlane(s.head<3>(), 0), s[3], 16 * epsilon * s.norm());
    Matrix back;
    material->elasticStrain(s, back);
    EXPECT_LE((back - strain).norm(), 16 * epsilon * strain.norm());
    EXPECT_NEAR(vonMises(s), static_cast<double>(Tensors::mises(Tensors::tensor(s))), 8 * epsilon * s.norm());
  }
}

// H^-1 is the derivative of the step's stress, solved in three-dimensional tensors, with respect to the
// strain. On the yield surface it is that of its outer side: one-sided differences of third order.
TEST(PlaneStrain, tangentMatchesFiniteDifference) {
  constexpr Long h = 1e-5L;
  constexpr double differences = 1e-10;
  constexpr double rounding = 8 * epsilon;
  double worst = 0;
  std::mt19937 random(7);
  for (const double nu : {0.3, -0.4, 0.49})
    for (const double thetaE : {1e-6, 1e-3, 1.0, 1e3, 1e8, 1e12})
      for (const double beyond : {-0.5, 1e-6, 1e-2, 0.5, 10.0, 1e6}) {
        const Elasticity elasticity{3e11, nu};
        const double weight = 2 * 10 * thetaE * (1 + nu) / 3e11;
        const Tensors law{elasticity, {10, 1}, weight};
        const auto material = perzynaMaterial(elasticity, {10, 1}, Plane::strain);
        const Vector4d s0 = randomStress4(random, 0.5, 0.1);
        // A trial beyond yield such that the stress is beyond it by `beyond`; a strain with a part across the
        // plane, as schemes of several stages have.
        const Vector4d trial = randomStress4(random, 1 + beyond * (beyond > 0 ? 1 + thetaE : 1), 0.7);
        Matrix strain;
        material->elasticStrain(trial - s0, strain);
        const Tensors::Tensor exact =
            law.stress(Tensors::tensor(s0) + law.stressOf(Tensors::tensor(strain.col(0))));
        const Vector4d s = Tensors::vector(exact);
        for (const bool anticipate : {false, true}) {
          const PointLaw found = lineariseAt(*material, weight, s0, strain.col(0), s, anticipate);
          for (int j = 0; j < 4; ++j) {
            const Vector4d direction = Vector4d::Unit(j);
            // Outwards, so that a difference never leaves the branch.
            const Long sign = (Tensors::deviator(exact).cwiseProduct(
                                   Tensors::deviator(law.stressOf(Tensors::tensor(direction)))))
                                          .sum() < 0
                                  ? -1
                                  : 1;
            const Long step = h * sign * strain.norm();
            const auto at = [&](int k) {
              return law.stress(Tensors::tensor(s0) + law.stressOf(Tensors::tensor(strain.col(0)) +
                                                                   k * step * Tensors::tensor(direction)));
            };
            const Tensors::Tensor derivative =
                (-11 * at(0) + 18 * at(1) - 9 * at(2) + 2 * at(3)) / (6 * step);
            const double error = (Tensors::vector(derivative) - found.moduli.col(j)).cwiseAbs().maxCoeff() /
                                 found.moduli.cwiseAbs().maxCoeff();
            const double tolerance = differences + rounding * (beyond > 0 ? 1 / beyond : 1);
            ASSERT_LE(error, tolerance) << "nu " << nu << ", theta e " << thetaE << ", beyond by " << beyond
                                        << ", column " << j << (anticipate ? ", anticipated" : "");
            worst = std::max(worst, error / tolerance);
          }
        }
      }
  std::cout << "tangent against differences: at most " << worst << " of the tolerance\n";
}

// On the surface itself, where the first rounded stress is not inside, the tangent is that of the outer side.
TEST(PlaneStrain, onTheYieldSurfaceItFlows) {
  std::mt19937 random(5);
  const auto material = perzynaMaterial({100, 0.3}, {10, 1}, Plane::strain);
  const double weight = 1e6;  // theta e = 4e6
  for (int k = 0; k < 50; ++k) {
    const Vector4d s = randomStress4(random, 1, 2);
    EXPECT_TRUE(material->flows(s, 0));
    Vector4d n = s;
    const double mean = (std::numbers::sqrt2 * s[0] + s[3]) / 3;
    n -= mean * Vector4d(std::numbers::sqrt2, 0, 0, 1);
    n.normalize();
    const PointLaw law = lineariseAt(*material, weight, s, Vector4d::Zero(), s);
    EXPECT_LE((law.moduli * n).norm(), 1e-4);  // soft along the normal
    EXPECT_GE(law.moduli.norm(), 100 / 1.3);   // elastic across it
    EXPECT_LE((law.predictor - s).norm(), 4 * epsilon * s.norm());
    EXPECT_FALSE(material->flows((1 - 1e-9) * s, 0));
  }
}

// Newton's method at a point ends at the radial return, whatever theta e; yielding anticipated in a few
// iterations.
TEST(PlaneStrain, newtonEndsAtTheRadialReturn) {
  constexpr double tolerance = 1e-12;
  std::mt19937 random(3);
  for (const double thetaE : {1e-6, 1.0, 1e3, 1e8, 1e12})
    for (const double size : {0.02, 1.0, 100.0})
      for (int k = 0; k < 100; ++k) {
        const Elasticity elasticity{100, 0.3};
        const double weight = 2 * 10 * thetaE * 1.3 / 100;
        const Tensors law{elasticity, {10, 1}, weight};
        const auto material = perzynaMaterial(elasticity, {10, 1}, Plane::strain);
        const Vector4d s0 = randomStress4(random, k % 2 == 0 ? 0.5 : 1.2, 0.1);
        const Vector4d strain = randomStress4(random, size, 0.1 * size);
        const Vector4d exact =
            Tensors::vector(law.stress(Tensors::tensor(s0) + law.stressOf(Tensors::tensor(strain))));
        const Vector4d anticipated = solveAt(*material, weight, s0, strain, s0, true, 8);
        ASSERT_LE((anticipated - exact).norm(), tolerance * exact.norm())
            << "theta e " << thetaE << ", size " << size;
        if (thetaE > 1e8) continue;
        const Vector4d plain = solveAt(*material, weight, s0, strain, s0, false, 20);
        ASSERT_LE((plain - exact).norm(), tolerance * exact.norm())
            << "theta e " << thetaE << ", size " << size;
      }
}

// The projections of all three norms are one: what the key says changes no bit.
TEST(PlaneStrain, theProjectionHasNoMeaning) {
  std::mt19937 random(9);
  const Vector4d s = randomStress4(random, 3, 1);
  const Vector4d strain = randomStress4(random, 1e-11, 0);
  const auto of = [&](Projection projection) {
    return lineariseAt(*perzynaMaterial({3e11, 0.3}, {10, 1, projection}, Plane::strain), 0.01, s, strain, s);
  };
  for (const Projection projection : projections) {
    EXPECT_EQ(of(projection).predictor, of(Projection::frobenius).predictor);
    EXPECT_EQ(of(projection).moduli, of(Projection::frobenius).moduli);
  }
  // In tensors: the nearest point of the cylinder in the norm (E x, x), by moving along it and across it.
  const Tensors law{{3e11, 0.3}, {10, 1}, 0};
  const Tensors::Tensor t = Tensors::tensor(s);
  const Tensors::Tensor nearest =
      Tensors::deviator(t) / Tensors::mises(t) + t.trace() / 3 * Tensors::Tensor::Identity();
  for (int k = 0; k < 200; ++k) {
    const Tensors::Tensor other =
        Tensors::tensor(randomStress4(random, 1, static_cast<double>(t.trace() / 3)));
    const auto distance = [&](const Tensors::Tensor& to) {
      return law.stressOf(t - to).cwiseProduct(t - to).sum();
    };
    EXPECT_GE(distance(other), distance(nearest));
  }
}

// Relaxation of a deviator of twice the yield stress, its strain held: sigma_Y + (1 + z)^-N by backward Euler
// with z = k E/(2 lambda (1 + nu)); the pressure stays.
TEST(PlaneStrain, relaxationFollowsItsClosedForm) {
  const double nu = 0.3;
  const auto material = perzynaMaterial({2 * 2 * 10 * (1 + nu), nu}, {10, 1}, Plane::strain);
  const double errors[][2] = {{10, 2.617e-2}, {40, 6.710e-3}, {160, 1.688e-3}};
  std::mt19937 random(2);
  const Vector4d start = randomStress4(random, 2, 5);
  for (const auto& [steps, error] : errors) {
    Vector4d s = start;
    for (int n = 0; n < static_cast<int>(steps); ++n)
      s = solveAt(*material, 1 / steps, s, Vector4d::Zero(), s);
    EXPECT_NEAR(vonMises(s), 1 + std::pow(1 + 2 / steps, -steps), 1e-13);
    EXPECT_NEAR(vonMises(s) - (1 + std::exp(-2.0)), error, 5e-4 * error);
    EXPECT_NEAR(std::numbers::sqrt2 * s[0] + s[3], std::numbers::sqrt2 * start[0] + start[3], 1e-13);
  }
}

TEST(PlaneStrain, pressureNeverFlowsAndRatesAreDeviators) {
  std::mt19937 random(4);
  const auto material = perzynaMaterial({100, 0.3}, {10, 1}, Plane::strain);
  const Vector4d pressure = 1e6 * Vector4d(std::numbers::sqrt2, 0, 0, 1);
  EXPECT_FALSE(material->flows(pressure, 0));
  const Vector4d s = randomStress4(random, 3, 7);
  Matrix rate;
  material->viscoplasticRate(s, rate);
  EXPECT_NEAR(std::numbers::sqrt2 * rate(0, 0) + rate(3, 0), 0, 4 * epsilon);
  EXPECT_NEAR(rate.norm(), (3 - 1) * std::sqrt(2.0 / 3) / 20, 8 * epsilon);
  material->viscoplasticRate(s / 4, rate);
  EXPECT_EQ(rate.norm(), 0);
}

TEST(PlaneStrain, wrongConstantsAreNamed) {
  EXPECT_THROW(elasticMaterial({0, 0.3}, Plane::strain), InputError);
  EXPECT_THROW(elasticMaterial({1, 0.5}, Plane::strain), InputError);
  EXPECT_THROW(perzynaMaterial({1, 0.3}, {0, 1}, Plane::strain), InputError);
  EXPECT_THROW(perzynaMaterial({1, 0.3}, {1, -2}, Plane::strain), InputError);
}

}  // namespace mortier::plane_strain_test
