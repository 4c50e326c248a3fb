#include "material/parts.h"

#include <gtest/gtest.h>

#include <cmath>

#include "base/parallel.h"
#include "material/interior_path.h"
#include "time/march.h"
#include "unit/one_point.h"
#include "unit/plate.h"

namespace mortier::parts_test {

using namespace plate;

const Elasticity soft{10, 0.2};
const Elasticity hard{100, 0.3};

std::vector<std::shared_ptr<const Material>> three() {
  return {elasticMaterial(soft), perzynaMaterial(hard, {10, 1, Projection::elasticity}),
          perzynaMaterial(soft, {3, 4, Projection::frobenius})};
}

Matrix elasticOf(const Material& material, const Matrix& stress) {
  Matrix strain;
  material.elasticStrain(stress, strain);
  return strain;
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
  const double residual = std::max(mixed->linearise(step, stress, law, 0, 30).change,
                                   mixed->linearise(step, stress, law, 30, points).change);
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

// What nothing flows in is not factorised again: the points of all parts count.
TEST(Parts, elasticPointsOfAllPartsAreCounted) {
  const std::vector<int> of{0, 0, 1, 1, 1, 2, 2, 0};
  const auto mixed = materialOfParts(three(), of);
  const auto points = static_cast<int>(of.size());
  const Matrix nothing = Matrix::Zero(3, points);
  Linearisation law = mixed->room(points);
  EXPECT_EQ(mixed->linearise({0.1, nothing, nothing}, nothing, law, 0, points).elastic, points);
  EXPECT_EQ(mixed->linearise({0.1, nothing, nothing}, nothing, law, 1, 6).elastic, 5);
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
  EXPECT_DOUBLE_EQ(mixed->linearise(step, stress, law, 0, 2).change / mixed->stressScale(), 0.25);
  stress(1, 0) = NAN;  // a sound point follows
  EXPECT_TRUE(std::isnan(mixed->linearise(step, stress, law, 0, 2).change));
}

TEST(Parts, interiorPathIsThatOfEachPart) {
  const auto materials = three();
  const std::vector<int> of{1, 0, 2, 1, 0};
  const auto mixed = materialOfParts(materials, of);
  std::mt19937 random(2);
  Matrix stress0(3, 5);
  Matrix strain(3, 5);
  Matrix change(3, 5);
  for (int i = 0; i < 5; ++i) {
    stress0.col(i) = randomStress(random, 0.5);
    strain.col(i) = randomStress(random, 0.1);
    change.col(i) = randomStress(random, 0.01);
  }
  const auto path = mixed->interiorPath(0.1, stress0);
  ASSERT_TRUE(path);
  EXPECT_EQ(path->points(), 3);
  path->begin(0.2);
  Linearisation law{Matrix(3, 5), Matrix(9, 5)};
  path->linearise(strain, 0, false, law);
  const double largest = path->direct(change);
  Matrix stress = stress0;
  path->advance(0.5, stress);
  double expectedLargest = INFINITY;
  double complementarity = 0;
  for (int i = 0; i < 5; ++i) {
    const Matrix s0 = stress0.col(i);
    const Matrix e = strain.col(i);
    Linearisation own{Matrix(3, 1), Matrix(9, 1)};
    Matrix s = s0;
    if (const auto alone = materials[of[i]]->interiorPath(0.1, s0)) {
      alone->begin(0.2);
      alone->linearise(e, 0, false, own);
      expectedLargest = std::min(expectedLargest, alone->direct(change.col(i)));
      alone->advance(0.5, s);
      complementarity += alone->complementarity();
    } else {
      materials[of[i]]->linearise({0.1, s0, e}, s0, own, 0, 1);
      // Half the way to the stress of the strain at the end of the direction.
      EXPECT_LE((elasticOf(*materials[of[i]], own.predictor - s0) - e).norm(), 1e-15);
      s = 0.5 * (s0 + own.predictor + Eigen::Map<const Eigen::Matrix3d>(own.moduli.data()) * change.col(i));
    }
    EXPECT_LE((law.predictor.col(i) - own.predictor.col(0)).norm(), 1e-12);
    EXPECT_LE((law.moduli.col(i) - own.moduli.col(0)).norm(), 1e-10);
    EXPECT_LE((stress.col(i) - s.col(0)).norm(), 1e-12);
  }
  EXPECT_DOUBLE_EQ(largest, expectedLargest);
  EXPECT_NEAR(path->complementarity(), complementarity, 1e-14);
  EXPECT_FALSE(materialOfParts({materials[0], elasticMaterial(hard)}, {0, 1})->interiorPath(0.1, stress0));
}

// What a step commits and reports is taken by blocks of points.
TEST(Parts, statesAndReportsMeetTheMaterialOfEveryBlock) {
  Conditions conditions;
  conditions.displacements = {{left, alongX, constant(0)}, {bottom, alongY, constant(0)}};
  conditions.tractions = {{top, alongY, [](double x, double, double t) { return (4 + x) * t; }}};
  const TriangleMesh mesh = crissCrossMesh({.cellsX = 30, .cellsY = 30});
  const auto triangles = static_cast<int>(mesh.triangles.size());
  ASSERT_GT(triangles, itemsOfBlock);
  std::vector<int> of(triangles, 1);
  std::fill(of.begin() + triangles / 2, of.end(), 2);
  Model model;
  model.bodies.emplace_back("square", mesh, materialOfParts(three(), of), conditions);
  State state = initialState(model);
  StepReport last;
  march(model, state, {1, 3, Scheme::backwardEuler}, {},
        [&](const State&, const StepReport& report) { last = report; });
  ASSERT_EQ(last.step, 3);
  EXPECT_GT(last.viscoplasticFraction, 0.5);

  const Body& body = model.bodies[0];
  const auto& [displacement, stress, viscoplasticStrain, work, thermalStrain] = state.bodies[0];
  Matrix strain(3, body.points());
  body.strain({displacement, Vector::Zero(displacement.size())}, nullptr, strain, 0, body.points());
  const Matrix elastic = elasticOf(body.material(), stress);
  EXPECT_LE((elastic + viscoplasticStrain - strain).cwiseAbs().maxCoeff(),
            1e-11 * strain.cwiseAbs().maxCoeff());
  double energy = 0;
  for (int i = 0; i < body.points(); ++i) energy += body.weights()[i] / 2 * stress.col(i).dot(elastic.col(i));
  EXPECT_NEAR(last.energy, energy, 1e-12 * energy);
}

}  // namespace mortier::parts_test
