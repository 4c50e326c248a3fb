#include "material/parts.h"

#include <gtest/gtest.h>

#include <cmath>

#include "unit/one_point.h"

namespace mortier {
namespace {

const Elasticity soft{10, 0.2};
const Elasticity hard{100, 0.3};

std::vector<std::shared_ptr<const Material>> three() {
  return {elasticMaterial(soft), perzynaMaterial(hard, {10, 1, Projection::elasticity}),
          perzynaMaterial(soft, {3, 4, Projection::frobenius})};
}

TEST(Parts, everyPointIsOfItsMaterial) {
  const auto materials = three();
  std::mt19937 random(1);
  std::uniform_int_distribution<int> pick(0, 2);
  constexpr int points = 53;
  std::vector<int> of(points);
  for (int& each : of) each = pick(random);
  for (int i = 20; i < 40; ++i) of[i] = 1;
  const auto mixed = materialOfParts(materials, of);
  Matrix stress(3, points);
  Matrix stress0(3, points);
  Matrix strain(3, points);
  for (int i = 0; i < points; ++i) {
    stress.col(i) = randomStress(random, 2);
    stress0.col(i) = randomStress(random, 0.5);
    strain.col(i) = randomStress(random, 0.02);
  }
  const MaterialStep step{0.1, stress0, strain};
  Linearisation law{Matrix::Zero(3, points), Matrix::Zero(9, points)};
  // In two halves, as threads may.
  const double residual =
      std::max(mixed->linearise(step, stress, law, 0, 30), mixed->linearise(step, stress, law, 30, points));
  Matrix rate;
  Matrix elastic;
  mixed->viscoplasticRate(stress, rate);
  mixed->elasticStrain(stress, elastic);
  Vector penalty;
  mixed->choosePenalty(stress, penalty);
  Linearisation regular{Matrix::Zero(3, points), Matrix::Zero(9, points)};
  mixed->regularise(step, stress, penalty, 0.5, regular, 0, points);
  double expected = 0;
  for (int i = 0; i < points; ++i) {
    const Material& alone = *materials[of[i]];
    const Answer answer = linearise(alone, 0.1, stress0.col(i), strain.col(i), stress.col(i));
    EXPECT_EQ(law.predictor.col(i), answer.predictor);
    EXPECT_EQ(law.moduli.col(i), answer.moduli.reshaped());
    Matrix one;
    alone.viscoplasticRate(stress.col(i), one);
    EXPECT_EQ(rate.col(i), one.col(0));
    alone.elasticStrain(stress.col(i), one);
    EXPECT_EQ(elastic.col(i), one.col(0));
    EXPECT_EQ(mixed->flows(stress, i), alone.flows(stress, i));
    Vector weight;
    alone.choosePenalty(stress.col(i), weight);
    EXPECT_EQ(penalty[i], weight[0]);
    const Matrix s0 = stress0.col(i);
    const Matrix e = strain.col(i);
    Linearisation own{Matrix(3, 1), Matrix(9, 1)};
    alone.regularise({0.1, s0, e}, stress.col(i), weight, 0.5, own, 0, 1);
    EXPECT_EQ(regular.predictor.col(i), own.predictor.col(0));
    EXPECT_EQ(regular.moduli.col(i), own.moduli.col(0));
    const double scale = of[i] > 0 ? alone.stressScale() : 1;
    expected = std::max(expected, (answer.predictor - stress.col(i)).cwiseAbs().maxCoeff() / scale);
  }
  EXPECT_NEAR(residual, expected, 1e-12 * expected);  // of predictors of order one
  EXPECT_EQ(mixed->stressScale(), 1);
}

TEST(Parts, isLinearAndSymmetricOnlyWhereAllAre) {
  const auto m = three();
  const auto of = [](std::vector<std::shared_ptr<const Material>> materials) {
    return materialOfParts(std::move(materials), {0, 1, 1});
  };
  EXPECT_TRUE(of({m[0], elasticMaterial(hard)})->linear());
  EXPECT_EQ(of({m[0], elasticMaterial(hard)})->stressScale(), 0);
  EXPECT_FALSE(of({m[0], m[2]})->linear());
  EXPECT_TRUE(of({m[0], m[2]})->symmetricTangent());
  EXPECT_FALSE(of({m[0], m[1]})->symmetricTangent());
  EXPECT_EQ(of({m[2], m[1]})->stressScale(), 1);
  EXPECT_EQ(of({m[0], m[2]})->stiffness(2), m[2]->stiffness(2));
}

TEST(Parts, residualsOfEachPartAreScaledByIts) {
  const auto materials = three();
  const auto mixed = materialOfParts(materials, {2, 0});
  Matrix stress = Matrix::Zero(3, 2);
  const Matrix none = Matrix::Zero(3, 2);
  Linearisation law{Matrix(3, 2), Matrix(9, 2)};
  const MaterialStep step{0, none, none};
  stress(0, 0) = 1;  // elastic at rest: the residual is the stress itself, 1 of a yield stress 4
  EXPECT_DOUBLE_EQ(mixed->linearise(step, stress, law, 0, 2) / mixed->stressScale(), 0.25);
  stress(1, 1) = NAN;
  EXPECT_TRUE(std::isnan(mixed->linearise(step, stress, law, 0, 2)));
}

}  // namespace
}  // namespace mortier
