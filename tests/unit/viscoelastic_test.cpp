#include "material/viscoelastic.h"

#include <gtest/gtest.h>

#include <random>

#include "base/error.h"
#include "material/interior_path.h"

namespace mortier::viscoelastic_test {

// Linear in stress and strain: the predictor is on the law, and the moduli take it to that of another strain.
TEST(Viscoelastic, predictorAndModuliAreExact) {
  std::mt19937 random(2);
  std::normal_distribution<double> normal;
  for (const Plane plane : {Plane::stress, Plane::strain})
    for (const double g : {0.0, 0.4})
      for (const double weight : {1e-6, 1e-3, 1.0, 1e3, 1e6}) {
        const auto material = viscoelasticMaterial({2, 0.3}, {0.7, g}, plane);
        const int n = material->components();
        const auto field = [&] { return Matrix(Matrix::NullaryExpr(n, 1, [&] { return normal(random); })); };
        const Matrix stress0 = field();
        const Matrix strain0 = field();
        const Matrix strain = field();
        const Matrix stress = field();
        Linearisation law = material->room(1);
        material->linearise({weight, stress0, strain, false, &strain0}, stress, law, 0, 1);
        const Matrix total = strain0 + strain;
        Matrix rate;
        Matrix elastic;
        material->viscoplasticRate(law.predictor, rate, &total);
        material->elasticStrain(law.predictor - stress0, elastic);
        EXPECT_LE((elastic + weight * rate - strain).norm(), 1e-13 * (1 + weight) * total.norm());
        const Matrix other = field();
        Linearisation moved = material->room(1);
        material->linearise({weight, stress0, other, false, &strain0}, stress, moved, 0, 1);
        EXPECT_LE(
            (law.predictor.col(0) + stressOf(law, other.col(0) - strain.col(0), 0) - moved.predictor.col(0))
                .norm(),
            1e-13 * (1 + moved.predictor.norm()));
        EXPECT_EQ(material->interiorPath(weight, stress0, &strain0), nullptr);
      }
}

// After all time shear has the part g of its stiffness, and volume all of it.
TEST(Viscoelastic, restIsElasticWithASofterShear) {
  constexpr double g = 0.4;
  const auto material = viscoelasticMaterial({2, 0.3}, {0.7, g}, Plane::stress);
  const double G = g * 2 / 2.6;
  const double K = 2 / (3 * 0.4);
  const double young = 9 * K * G / (3 * K + G);
  const double poisson = (3 * K - 2 * G) / (2 * (3 * K + G));
  const Matrix strain = Eigen::Vector3d(0.3, -0.2, 0.5);
  const Matrix zero = Matrix::Zero(3, 1);
  Linearisation law = material->room(1);
  material->linearise({1e12, zero, strain, false, &zero}, zero, law, 0, 1);
  const Eigen::Array3d relaxed = Elasticity{young, poisson}.moduli() * strain.col(0).array();
  EXPECT_LE((law.predictor.col(0) - relaxed.matrix()).norm(), 1e-10 * relaxed.matrix().norm());
}

TEST(Viscoelastic, rejectsWhatDoesNotRelax) {
  const auto make = [](const Viscoelasticity& law) {
    return viscoelasticMaterial({1, 0.3}, law, Plane::strain);
  };
  EXPECT_EQ(make({1, 0})->laws().front().text(), "Maxwell");
  EXPECT_EQ(make({1, 0.5})->laws().front().text(), "standard linear solid");
  EXPECT_FALSE(make({1, 0})->needsTotalStrain());
  for (const Viscoelasticity& law :
       {Viscoelasticity{0, 0}, {-1, 0}, {1, 1}, {1, -0.1}, {1, NAN}, {INFINITY, 0}})
    EXPECT_THROW(make(law), InputError);
}

}  // namespace mortier::viscoelastic_test
