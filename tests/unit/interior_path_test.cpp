#include "material/interior_path.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <iostream>
#include <random>

#include "unit/one_point.h"

namespace mortier::interior_path_test {

/// One step of the method at a point whose strain does not change. \returns the length of the step.
double follow(InteriorPath& path, const Matrix& strain, Matrix& stress) {
  Linearisation law{Matrix(3, strain.cols()), Matrix(9, strain.cols())};
  const Matrix still = Matrix::Zero(3, strain.cols());
  path.linearise(strain, 0, false, law);
  const double open = std::min(1.0, path.direct(still));
  const double centering = std::max(1e-6, std::pow(1 - open, 3));
  path.linearise(strain, centering * path.complementarity() / path.points(), true, law);
  const double length = std::min(1.0, 0.99 * path.direct(still));
  path.advance(length, stress);
  return length;
}

// At the end of the path stands the stress that the law asks for, however stiff it is; points that flow and
// points that do not go there side by side.
TEST(InteriorPath, endsAtTheStressOfTheLaw) {
  constexpr double difference = 1e-10;
  constexpr int iterations = 60;
  constexpr int points = 20;
  double worst = 0;
  std::mt19937 random(3);
  std::uniform_real_distribution<double> decades(-3, 3);
  for (const Projection projection : projections)
    for (const double nu : {0.3, -0.4, 0.49})
      for (const double thetaE : {1e-6, 1e-3, 1.0, 1e3, 1e8, 1e12}) {
        const Elasticity elasticity{3e11, nu};
        const double weight = 2 * 10 * thetaE / elasticity.moduli().maxCoeff();
        const Law law{elasticity, {10, 1, projection}, weight};
        const auto material = perzynaMaterial(law.elasticity, law.viscoplasticity);
        Matrix stress0(3, points);
        Matrix strain(3, points);
        std::vector<Vector3d> expected;
        for (int i = 0; i < points; ++i) {
          stress0.col(i) = randomStress(random, 0.5);
          const Vector3d trial = randomStress(random, std::pow(10, decades(random)));
          strain.col(i) = ((trial - stress0.col(i)).array() / elasticity.moduli()).matrix();
          expected.push_back(
              law.stress((stress0.col(i).array() + elasticity.moduli() * strain.col(i).array()).cast<Long>())
                  .cast<double>()
                  .matrix());
        }
        const auto path = material->interiorPath(weight, stress0);
        path->begin(100 * path->flowAtTwiceYield());
        Matrix stress = stress0;
        for (int k = 0; k < iterations; ++k) follow(*path, strain, stress);
        for (int i = 0; i < points; ++i)
          worst = std::max(worst, (stress.col(i) - expected[i]).norm() / expected[i].norm());
      }
  std::cout << "worst difference " << worst << "\n";
  EXPECT_LT(worst, difference);
}

// predictor + moduli de is where a short step for the strain de leads: their difference is of second order.
TEST(InteriorPath, moduliAreTheDerivativeOfItsSteps) {
  constexpr double h = 1e-6;
  constexpr double secondOrder = 1e-4;
  std::mt19937 random(5);
  std::normal_distribution<double> normal;
  for (const Projection projection : projections)
    for (const double thetaE : {1e-3, 1.0, 1e8}) {
      const Elasticity elasticity{3e11, 0.3};
      const double weight = 2 * 10 * thetaE / elasticity.moduli().maxCoeff();
      const auto material = perzynaMaterial(elasticity, {10, 1, projection});
      const Matrix stress0 = randomStress(random, 0.5);
      const Matrix strain = (3 * randomStress(random, 1).array() / elasticity.moduli()).matrix();
      const auto path = material->interiorPath(weight, stress0);
      Matrix stress = stress0;
      for (int k = 0; k < 4; ++k) follow(*path, strain, stress);
      Linearisation law{Matrix(3, 1), Matrix(9, 1)};
      path->linearise(strain, 0.1, false, law);
      Matrix change(3, 1);
      for (int c = 0; c < 3; ++c) change(c, 0) = normal(random) * strain.norm();
      const Vector3d reached =
          law.predictor + Eigen::Map<const Eigen::Matrix3d>(law.moduli.data()) * change.col(0);
      const Vector3d before = stress.col(0);
      path->direct(change);
      path->advance(h, stress);
      const Vector3d slope = (stress.col(0) - before) / h;
      EXPECT_LT((slope - (reached - before)).norm(), secondOrder * (reached - before).norm())
          << "projection " << static_cast<int>(projection) << ", theta e " << thetaE;
    }
}

TEST(InteriorPath, moduliAreSymmetricWhereTheLawIs) {
  std::mt19937 random(9);
  const Elasticity elasticity{3e11, 0.3};
  const auto material = perzynaMaterial(elasticity, {10, 1, Projection::frobenius});
  const Matrix stress0 = randomStress(random, 0.5);
  const Matrix strain = (30 * randomStress(random, 1).array() / elasticity.moduli()).matrix();
  const auto path = material->interiorPath(0.01, stress0);
  Matrix stress = stress0;
  for (int k = 0; k < 12; ++k) {
    follow(*path, strain, stress);
    Linearisation law{Matrix(3, 1), Matrix(9, 1)};
    path->linearise(strain, 0, false, law);
    const Eigen::Matrix3d moduli = Eigen::Map<const Eigen::Matrix3d>(law.moduli.data());
    EXPECT_LT((moduli - moduli.transpose()).norm(), 1e-12 * moduli.norm()) << "iteration " << k;
  }
}

// Complementarity stays positive, and does not grow, whatever the strain asks for.
TEST(InteriorPath, staysInside) {
  std::mt19937 random(11);
  const Elasticity elasticity{3e11, 0.3};
  const auto material = perzynaMaterial(elasticity, {10, 1, Projection::elasticity});
  const Matrix stress0 = Matrix::Zero(3, 1);
  for (int k = 0; k < 200; ++k) {
    const Matrix strain =
        (randomStress(random, std::pow(10, k % 7 - 3)).array() / elasticity.moduli()).matrix();
    const auto path = material->interiorPath(1e-3, stress0);
    Matrix stress = stress0;
    for (int i = 0; i < 15; ++i) {
      const double before = path->complementarity();
      const double length = follow(*path, strain, stress);
      ASSERT_GT(length, 0);
      ASSERT_GT(path->complementarity(), 0);
      ASSERT_LE(path->complementarity(), 2 * before);
    }
  }
}

TEST(InteriorPath, aLinearLawHasNone) {
  EXPECT_EQ(elasticMaterial({3e11, 0.3})->interiorPath(1, Matrix::Zero(3, 1)), nullptr);
}

}  // namespace mortier::interior_path_test
