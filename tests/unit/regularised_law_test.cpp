// The law as the penalty-duality method takes it, against its definition (material/material.h).
#include <gtest/gtest.h>

#include <Eigen/LU>

#include "material/deviatoric.h"
#include "unit/one_point.h"

namespace mortier::regularised_law_test {

constexpr Elasticity elasticity{100, 0.3};
constexpr double viscosity = 2;
constexpr double weight = 0.3;
constexpr double theta = weight / (2 * viscosity);

/// D of a point, column by column.
Matrix moduliOf(const Linearisation& law, int components, int point) {
  Matrix D(components, components);
  for (int k = 0; k < components; ++k) D.col(k) = stressOf(law, Vector::Unit(components, k), point);
  return D;
}

/// With relaxation 1 the predictor t is on the law at the strain + D^-1 (s - t).
void expectRegularised(const Material& material) {
  constexpr double rounding = 1e-12;
  constexpr int points = 13;
  const int n = material.components();
  std::mt19937 random(n);
  std::normal_distribution<double> normal;
  const auto field = [&](double size) {
    return Matrix(Matrix::NullaryExpr(n, points, [&] { return size * normal(random); }));
  };
  const Matrix stress0 = field(0.5);
  Matrix strain = field(0.03);
  if (n == 4) strain.row(3).setZero();
  const Matrix stress = field(2);
  const Vector penalty = Vector::NullaryExpr(points, [&] { return std::abs(normal(random)); });
  Linearisation result = material.room(points);
  const double change =
      material.regularise({weight, stress0, strain}, stress, penalty, 1, result, 0, points).change;
  const Matrix& t = result.predictor;
  EXPECT_NEAR(change, (t - stress).cwiseAbs().maxCoeff(), rounding);
  Matrix elastic;
  Matrix rate;
  Matrix unit;
  material.elasticStrain(t - stress0, elastic);
  material.viscoplasticRate(t, rate);
  material.elasticStrain(Matrix::Identity(n, n), unit);
  for (int i = 0; i < points; ++i) {
    const Matrix inverse = moduliOf(result, n, i).inverse();
    const Vector added = inverse * (stress.col(i) - t.col(i));
    EXPECT_LE((elastic.col(i) + weight * rate.col(i) - strain.col(i) - added).cwiseAbs().maxCoeff(), rounding)
        << n << " components, point " << i;
    if (n == 3 && !material.linear()) {  // D^-1 = E^-1 + w
      const Matrix penalised = unit + penalty[i] * theta * Matrix::Identity(n, n);
      EXPECT_LE((inverse - penalised).cwiseAbs().maxCoeff(), rounding);
    }
  }
}

TEST(RegularisedLaw, isTheLawAtTheStrainThatThePenaltyAdds) {
  expectRegularised(*elasticMaterial(elasticity));
  expectRegularised(*elasticMaterial(elasticity, Plane::strain));
  for (const Projection projection : projections) {
    expectRegularised(*perzynaMaterial(elasticity, {viscosity, 1, projection}));
    expectRegularised(*perzynaMaterial(elasticity, {viscosity, 1, projection}, Plane::strain));
  }
}

}  // namespace mortier::regularised_law_test
