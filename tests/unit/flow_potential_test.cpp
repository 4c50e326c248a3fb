// The potential of the flow, and what stresses add to it.
#include "bound/flow_potential.h"

#include <gtest/gtest.h>

#include "material/deviatoric.h"
#include "material/parts.h"
#include "theory/scenes.h"
#include "unit/enumerated_contact.h"

namespace mortier::flow_potential_test {

using namespace scenes;

const Elasticity elasticity{2, 0.3};

Body blockOf(const std::shared_ptr<const Material>& material) {
  return {"block", square(0, 1), material, {}};
}

TEST(FlowPotential, knowsWhatFlowsInWhichTriangle) {
  const Body body = blockOf(materialOfParts(
      {perzynaMaterial(elasticity, {3, 0.5, Projection::frobenius}),
       perzynaMaterial(elasticity, {7, 40, Projection::frobenius}), elasticMaterial(elasticity)},
      {0, 1, 2, 0}));
  const std::vector<int> parents{0, 1, 2, 3, 1, 0};  // the last two are parts of triangles
  FlowPotential potential(body, parents);
  const std::vector<double> viscosities{3, 7, 0, 3, 7, 3};
  for (int t = 0; t < 6; ++t)
    EXPECT_NEAR(potential.fluidity()[t], viscosities[t] > 0 ? 1 / (2 * viscosities[t]) : 0, 1e-15) << t;
  EXPECT_EQ(potential.together(0), 4);
  EXPECT_EQ(potential.together(4), 1);
  const Matrix stress = Eigen::Vector3d(1, -2, 70).replicate(1, 4);
  Matrix expected;
  body.material().viscoplasticRate(stress, expected);
  EXPECT_EQ(potential.rates(0, stress), expected);
  for (const int t : {4, 5})
    EXPECT_EQ(potential.rates(t, stress.leftCols(1)).col(0), expected.col(parents[t]));
}

// By the definition, where nothing cancels: phi = lambda |G|^2.
TEST(FlowPotential, excessIsThatOfThePotential) {
  constexpr double viscosity = 3;
  const Viscoplasticity law{viscosity, 0.8, Projection::frobenius};
  for (const auto& material :
       {perzynaMaterial(elasticity, law), perzynaMaterial(elasticity, law, Plane::strain)}) {
    const Body body = blockOf(material);
    const std::vector<int> parents{0, 1, 2, 3};
    FlowPotential potential(body, parents);
    Randoms random(5);
    int beyond = 0;
    for (int i = 0; i < 300; ++i) {
      const double size = i % 3 == 0 ? 0.3 : 2;
      const PointVector t = size * random.vector(material->components());
      const PointVector s =
          i % 5 == 0 ? PointVector(t) : PointVector(size * random.vector(material->components()));
      const PointVector rate = potential.rates(0, t).col(0);
      const PointVector rateOfS = potential.rates(0, s).col(0);
      const FlowExcess excess{t, rate, potential.fluidity()[0]};
      const double D = viscosity * (rateOfS.squaredNorm() - rate.squaredNorm()) - rate.dot(s - t);
      const double all = (s - t).squaredNorm() / (4 * viscosity);
      EXPECT_NEAR(excess.above(s, rateOfS), D, 1e-13);
      EXPECT_NEAR(excess.below(s, rateOfS), all - D, 1e-13);
      EXPECT_GE(D, -1e-14);
      EXPECT_LE(D, all + 1e-14);
      beyond += D > 0.01 * all && D < 0.99 * all;
    }
    EXPECT_GT(beyond, 50);
  }
}

}  // namespace mortier::flow_potential_test
