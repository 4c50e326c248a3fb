// The general form eps' = E^-1 s' + G(s, eps), any symmetric elliptic E: laws that the program does not have,
// run by what runs those that it has.
#include "material/point_material.h"

#include <gtest/gtest.h>

#include <random>

#include "material/parts.h"
#include "unit/one_point.h"
#include "unit/relaxing_law.h"

namespace mortier::point_material_test {

template <int n>
void expectGeneralLaw() {
  constexpr double rounding = 1e-12;
  constexpr int points = 11;
  constexpr double weight = 0.7;
  constexpr double eta = 3;
  std::mt19937 random(4);
  std::normal_distribution<double> normal;
  const auto field = [&] { return Matrix(Matrix::NullaryExpr(n, points, [&] { return normal(random); })); };
  const Eigen::Matrix<double, n, n> E = elliptic<n>(random);
  Eigen::Matrix<double, n, n> K = elliptic<n>(random);
  K(0, 1) += 0.5;  // no symmetry is needed
  const auto material = pointMaterial(Relaxing<n>(E, K, eta), {"relaxing", "", {}});
  const Matrix stress0 = field();
  const Matrix strain0 = field();
  const Matrix strain = field();
  const Matrix stress = field();
  Linearisation law = material->room(points);
  const LawReport report =
      material->linearise({weight, stress0, strain, false, &strain0}, stress, law, 0, points);
  EXPECT_NEAR(report.change, (law.predictor - stress).cwiseAbs().maxCoeff(), rounding);
  EXPECT_EQ(report.elastic, 0);
  // The law is linear in s and eps: the predictor is on it.
  const Matrix total = strain0 + strain;
  Matrix rate;
  Matrix elastic;
  material->viscoplasticRate(law.predictor, rate, &total);
  material->elasticStrain(law.predictor - stress0, elastic);
  EXPECT_LE((elastic + weight * rate - strain).cwiseAbs().maxCoeff(), rounding);
  // And the moduli take it to that of another strain.
  const Matrix other = field();
  Linearisation moved = material->room(points);
  material->linearise({weight, stress0, other, false, &strain0}, stress, moved, 0, points);
  for (int i = 0; i < points; ++i)
    EXPECT_LE((law.predictor.col(i) + stressOf(law, other.col(i) - strain.col(i), i) - moved.predictor.col(i))
                  .cwiseAbs()
                  .maxCoeff(),
              rounding);
  EXPECT_EQ(material->laws().front().text(), "relaxing");
  EXPECT_EQ(material->interiorPath(weight, stress0, &strain0), nullptr);
}

TEST(PointMaterial, takesAnyElasticityAndAnyFlowOfStressAndStrain) {
  expectGeneralLaw<3>();
  expectGeneralLaw<4>();
}

// Beside a law with a path of its own, one without follows Newton's method.
TEST(PointMaterial, lawsWithoutAPathFollowThePathOfOthers) {
  constexpr double weight = 0.5;
  std::mt19937 random(8);
  const auto own = pointMaterial(Relaxing<3>(elliptic<3>(random), elliptic<3>(random), 2), {});
  const auto mixed = materialOfParts({perzynaMaterial({1, 0.3}, {1, 1}), own}, {0, 1});
  EXPECT_TRUE(mixed->needsTotalStrain());
  const Matrix stress0 = Matrix::Zero(3, 2);
  const Matrix strain0 = Matrix::Constant(3, 2, 0.2);
  const Matrix strain = Matrix::Constant(3, 2, 0.1);
  const auto path = mixed->interiorPath(weight, stress0, &strain0);
  ASSERT_TRUE(path);
  EXPECT_EQ(path->points(), 1);
  path->begin(1);
  Linearisation law = mixed->room(2);
  path->linearise(strain, 0, false, law);
  path->direct(Matrix::Zero(3, 2));
  Matrix stress = stress0;
  path->advance(0.5, stress);
  Linearisation alone = own->room(2);
  own->linearise({weight, stress0, strain, false, &strain0}, stress0, alone, 0, 2);
  EXPECT_LE((stress.col(1) - 0.5 * alone.predictor.col(1)).norm(), 1e-14);
}

TEST(PointMaterial, saysWhatItIs) {
  const LawDescription law = perzynaMaterial({100, 0.3}, {10, 1, Projection::compliance})->laws().front();
  EXPECT_EQ(law.text(), "Perzyna (compliance)");
  ASSERT_EQ(law.parameters.size(), 4);
  EXPECT_EQ(law.parameters[0].name, "young");
  EXPECT_EQ(law.parameters[0].value, 100);
  EXPECT_EQ(law.parameters[2].unit, "Pa s");
  EXPECT_EQ(elasticMaterial({1, 0.3})->laws().front().text(), "elastic");
}

}  // namespace mortier::point_material_test
