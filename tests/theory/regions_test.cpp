// Bodies of several materials and bodies with an initial stress.
#include <gtest/gtest.h>

#include <cmath>

#include "base/error.h"
#include "material/deviatoric.h"
#include "material/parts.h"
#include "theory/scenes.h"
#include "time/initial_balance.h"

namespace mortier::regions_test {

using namespace scenes;

/// Pressed down by 0.06 t, then held: sides free.
Conditions pressed() {
  return {{{left, 0, constant(0)},
           {bottom, 1, constant(0)},
           {top, 1, [](double, double, double t) { return -0.06 * std::min(t, 1.0); }}},
          {},
          {}};
}

// Columns side by side, bonded: the elastic one and the two that flow are as they would be alone.
void expectColumnsAsAlone(const std::vector<std::shared_ptr<const Material>>& materials) {
  constexpr double rounding = 1e-9;
  TriangleMesh mesh = crissCrossMesh({.lower = {0, 0}, .upper = {3, 1}, .cellsX = 9, .cellsY = 4});
  std::vector<int> of;
  for (const auto& [a, b, c] : mesh.triangles)
    of.push_back(static_cast<int>((mesh.vertices[a].x() + mesh.vertices[b].x() + mesh.vertices[c].x()) / 3));
  Model together;
  together.bodies.emplace_back("columns", std::move(mesh), materialOfParts(materials, of), pressed());
  const Result result = run(together, 2, 10);
  ASSERT_EQ(result.report.status, Status::converged) << result.report.reason;
  for (int k = 0; k < 3; ++k) {
    Model alone;
    alone.bodies.emplace_back("column", square(0, 2), materials[k], pressed());
    const Result expected = run(alone, 2, 10);
    ASSERT_EQ(expected.report.status, Status::converged);
    const BodyState& column = expected.state.bodies[0];
    for (size_t i = 0; i < of.size(); ++i) {
      if (of[i] != k) continue;
      EXPECT_LE((result.state.bodies[0].stress.col(i) - column.stress.col(0)).norm(), rounding);
      EXPECT_LE((result.state.bodies[0].viscoplasticStrain.col(i) - column.viscoplasticStrain.col(0)).norm(),
                rounding);
    }
    EXPECT_EQ(column.viscoplasticStrain.norm() > 0, k > 0);
  }
}

TEST(Regions, columnsOfDifferentMaterialsAreAsAlone) {
  expectColumnsAsAlone({elasticMaterial({100, 0.2}),
                        perzynaMaterial({100, 0.3}, {1, 1, Projection::elasticity}),
                        perzynaMaterial({300, 0.1}, {5, 2, Projection::frobenius})});
}

TEST(Regions, columnsAreAsAloneInPlaneStrain) {
  expectColumnsAsAlone({elasticMaterial({100, 0.2}, Plane::strain),
                        perzynaMaterial({100, 0.3}, {1, 1}, Plane::strain),
                        perzynaMaterial({300, 0.1}, {5, 2}, Plane::strain)});
}

/// Both squares of the compression test with a stress from the start and a constant load.
Model stressed(double upperStress, double lowerStress, double load,
               const std::shared_ptr<const Material>& material) {
  Conditions upper{{{left, 0, constant(0)}}, {{top, alongNormal, constant(-load)}}, {}};
  Conditions lower{{{left, 0, constant(0)}, {bottom, 1, constant(0)}}, {}, {}};
  upper.initialStresses = {{0, {}, constant(7)}, {0, 1, constant(0)}, {1, {}, constant(upperStress)}};
  lower.initialStresses = {{1, {}, constant(lowerStress)}};
  return contactModel({"upper", square(0, 3), material, upper}, {"lower", square(-1, 4), material, lower},
                      CouplingKind::mortar, upperBody);
}

TEST(InitialStress, inEquilibriumNothingMoves) {
  constexpr double rounding = 1e-12;
  for (const auto& material :
       {elasticMaterial({100, 0.3}), perzynaMaterial({100, 0.3}, {1, 10, Projection::frobenius})}) {
    const Model model = stressed(-5, -5, 5, material);
    State state = initialState(model);
    EXPECT_EQ(model.interfaces[0].initialDistance().minCoeff(), 0);
    EXPECT_LE(balanceInitialStress(model, state, {}), rounding);
    EXPECT_NEAR(state.contactForce[0].sum(), 5, rounding);
    for (const BodyState& body : state.bodies) EXPECT_LE(body.displacement.cwiseAbs().maxCoeff(), rounding);
    // And goes on without moving.
    const RunReport report =
        march(model, state, {.end = 1, .steps = 3}, {}, [](const State&, const StepReport&) {});
    ASSERT_EQ(report.status, Status::converged);
    for (const BodyState& body : state.bodies) {
      EXPECT_LE(body.displacement.cwiseAbs().maxCoeff(), rounding);
      for (Eigen::Index i = 0; i < body.stress.cols(); ++i)
        EXPECT_LE((toCartesian(body.stress.col(i)) - Eigen::Vector3d(0, -5, 0)).norm(), 10 * rounding);
    }
  }
}

TEST(InitialStress, outOfEquilibriumTheBodiesSettleElastically) {
  constexpr double rounding = 1e-12;
  const Model model = stressed(-2, 0, 5, elasticMaterial({100, 0.3}));
  State state = initialState(model);
  // By 5 in the lower square, over 5.
  EXPECT_NEAR(balanceInitialStress(model, state, {}), 1, rounding);
  for (const BodyState& body : state.bodies)
    for (Eigen::Index i = 0; i < body.stress.cols(); ++i)
      EXPECT_LE((toCartesian(body.stress.col(i)) - Eigen::Vector3d(0, -5, 0)).norm(), 100 * rounding);
  // Strains of -3/E above, -5/E below.
  const auto onTop = [](const Point& x) { return x.y() == 1; };
  EXPECT_LE(displacementRange(model.bodies[0], state.bodies[0], 1, onTop).distance(-0.08), rounding);
}

TEST(InitialStress, thatNothingBalancesIsRefused) {
  // Pulled up: contact cannot hold it.
  const Model model = stressed(3, 3, -3, elasticMaterial({100, 0.3}));
  State state = initialState(model);
  EXPECT_THROW(balanceInitialStress(model, state, {}), UnheldBodyError);
}

}  // namespace mortier::regions_test
