// Plane strain along the two ways round a hard step: the regularised law and the interior path.
#include "material/deviatoric.h"

#include <gtest/gtest.h>

#include <Eigen/Cholesky>

#include "material/interior_path.h"
#include "unit/plane_strain_point.h"

namespace mortier::plane_strain_path_test {

// What regularise() leaves is nothing where the law holds, and its fixed point is the law.
TEST(PlaneStrain, regularisedLawEndsAtTheLaw) {
  std::mt19937 random(6);
  const Elasticity elasticity{100, 0.3};
  const double weight = 3;
  const Tensors law{elasticity, {10, 1}, weight};
  for (const bool flowing : {false, true}) {
    const auto material = flowing ? perzynaMaterial(elasticity, {10, 1}, Plane::strain)
                                  : elasticMaterial(elasticity, Plane::strain);
    const Matrix stress0 = randomStress4(random, 0.5, 0.2);
    const Matrix strain = randomStress4(random, 0.05, 0.01);
    Matrix stress = stress0;
    Vector penalty;
    material->choosePenalty(2 * stress0.normalized() * 2, penalty);
    Linearisation result = roomFor(1);
    const MaterialStep step{weight, stress0, strain};
    // With D B d = 0 the stress goes to the law under the strain that is given.
    double change = 0;
    for (int k = 0; k < 400; ++k) {
      change = material->regularise(step, stress, penalty, 1.5, result, 0, 1).change;
      stress = result.predictor;
    }
    const Vector4d trial = Tensors::vector(Tensors::tensor(stress0) + law.stressOf(Tensors::tensor(strain)));
    const Vector4d exact = flowing ? Tensors::vector(law.stress(Tensors::tensor(trial))) : trial;
    EXPECT_LE(change, 1e-13 * exact.norm());
    EXPECT_LE((stress - exact).norm(), 1e-12 * exact.norm());
    // Its moduli are D: symmetric, positive, E where nothing flows.
    const PointLaw D = take(result, 0);
    EXPECT_EQ(Eigen::LLT<Eigen::Matrix4d>(D.moduli).info(), Eigen::Success);
    if (!flowing) {
      EXPECT_LE((D.moduli * strain - (trial - stress0)).norm(), 1e-13 * trial.norm());
    }
  }
}

// The path ends at the radial return, however stiff the law.
TEST(PlaneStrain, pathEndsAtTheRadialReturn) {
  constexpr int points = 20;
  std::mt19937 random(3);
  std::uniform_real_distribution<double> decades(-3, 3);
  for (const double thetaE : {1e-6, 1.0, 1e3, 1e8, 1e12}) {
    const Elasticity elasticity{3e11, 0.3};
    const double weight = 2 * 10 * thetaE * 1.3 / 3e11;
    const Tensors law{elasticity, {10, 1}, weight};
    const auto material = perzynaMaterial(elasticity, {10, 1}, Plane::strain);
    Matrix stress0(4, points);
    Matrix trial(4, points);
    for (int i = 0; i < points; ++i) {
      stress0.col(i) = randomStress4(random, 0.5, 0.3);
      trial.col(i) = randomStress4(random, std::pow(10, decades(random)), 0.5);
    }
    Matrix strain;
    material->elasticStrain(trial - stress0, strain);
    const auto path = material->interiorPath(weight, stress0);
    path->begin(100 * path->flowAtTwiceYield());
    const Matrix still = Matrix::Zero(4, points);
    Matrix stress = stress0;
    Linearisation found = roomFor(points);
    for (int k = 0; k < 60; ++k) {
      path->linearise(strain, 0, false, found);
      const double open = std::min(1.0, path->direct(still));
      const double centering = std::max(1e-6, std::pow(1 - open, 3));
      path->linearise(strain, centering * path->complementarity() / path->points(), true, found);
      path->advance(std::min(1.0, 0.99 * path->direct(still)), stress);
    }
    for (int i = 0; i < points; ++i) {
      const Vector4d exact = Tensors::vector(
          law.stress(Tensors::tensor(stress0.col(i)) + law.stressOf(Tensors::tensor(strain.col(i)))));
      EXPECT_LE((stress.col(i) - exact).norm(), 1e-10 * exact.norm()) << "theta e " << thetaE;
    }
  }
}

// predictor + H^-1 de is where a short step of the path for the strain de leads, s33 included.
TEST(PlaneStrain, pathModuliAreTheDerivativeOfItsSteps) {
  constexpr double h = 1e-6;
  std::mt19937 random(5);
  for (const double thetaE : {1e-3, 1.0, 1e8}) {
    const double weight = 2 * 10 * thetaE * 1.3 / 3e11;
    const auto material = perzynaMaterial({3e11, 0.3}, {10, 1}, Plane::strain);
    const Matrix stress0 = randomStress4(random, 0.5, 0.2);
    Matrix strain;
    material->elasticStrain(randomStress4(random, 3, 1), strain);
    const auto path = material->interiorPath(weight, stress0);
    path->begin(100 * path->flowAtTwiceYield());
    Matrix stress = stress0;
    Linearisation law = roomFor(1);
    for (int k = 0; k < 4; ++k) {
      path->linearise(strain, 0, false, law);
      path->advance(std::min(1.0, 0.9 * path->direct(Matrix::Zero(4, 1))), stress);
    }
    path->linearise(strain, 0.1, false, law);
    Matrix change = strain.norm() * randomStress4(random, 1, 0.5);
    const Vector4d reached = law.predictor.col(0) + stressOf(law, change.col(0), 0);
    const Vector4d before = stress.col(0);
    path->direct(change);
    path->advance(h, stress);
    EXPECT_LT(((stress.col(0) - before) / h - (reached - before)).norm(), 1e-4 * (reached - before).norm())
        << "theta e " << thetaE;
  }
}

}  // namespace mortier::plane_strain_path_test
