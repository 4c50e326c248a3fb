// Guaranteed bounds of the error against exact solutions, and against solutions on much finer meshes.
#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cstdlib>
#include <iostream>

#include "bound/energy_bound.h"
#include "material/deviatoric.h"
#include "theory/half_open_contact.h"
#include "theory/random_scene.h"
#include "theory/refined_model.h"

namespace mortier::energy_bound_test {

using namespace scenes;

// ---- an exact solution
TEST(EnergyBound, isAboveAndNearTheErrorOfContactWithAKnownEnd) {
  double largestGap = 0;  // twice the integral of p^ G(u^), of the square of the bound
  for (const Plane plane : {Plane::stress, Plane::strain})
    for (const CouplingKind coupling : couplings)
      for (const double contrast : {1.0, 100.0, 0.01})
        for (const int cells : {8, 16, 32}) {
          if (plane == Plane::strain && cells > 8) continue;
          const std::array<HalfOpenContact, 2> exact{
              {{{1, 0.3}, false, plane}, {{contrast, 0.3}, true, plane}}};
          const Model model =
              contactModel(exact[0].body(cells), exact[1].body(3 * cells / 2 + 1), coupling, upperBody);
          const auto [state, report] = run(model, 1, 1);
          ASSERT_EQ(report.status, Status::converged);
          double error = 0;
          double norm = 0;
          for (int b = 0; b < 2; ++b)
            exact[b].addEnergies(model.bodies[b], state.bodies[b].stress, error, norm);
          const EnergyBound bound = energyBound(model, state);
          ASSERT_EQ(bound.obstacle, "");
          const double over = bound.bound / std::sqrt(error);
          std::cout << nameOf(coupling) << ", contrast " << contrast << ", " << cells << " cells: " << over
                    << "\n";
          // Data are not linear on sides here: what they are off by is small against the error.
          EXPECT_GE(over, 1);
          EXPECT_LE(over, coupling == CouplingKind::mortar && contrast == 1 ? 1.25 : 1.5);
          EXPECT_LE(bound.imbalance, 1e-14);
          EXPECT_LE(bound.mismatch, 1e-14);
          const double square = bound.bound * bound.bound;
          EXPECT_NEAR(bound.stress * bound.stress + bound.lift * bound.lift + 2 * bound.gap, square,
                      1e-12 * square);
          largestGap = std::max(largestGap, 2 * bound.gap / square);
        }
  EXPECT_GT(largestGap, 1e-3);
}

// ---- stresses that are exact
TEST(EnergyBound, isZeroToRoundingWhereTheStressIsExact) {
  for (const int cells : {6, 16}) {
    const Model model =
        compression(cells, 22 - cells, elasticMaterial(noteElasticity), CouplingKind::mortar, upperBody);
    const auto [state, report] = run(model, 1, 1);
    const EnergyBound bound = energyBound(model, state);
    ASSERT_EQ(bound.obstacle, "");
    EXPECT_LE(bound.bound, 1e-13 * bound.norm);
  }
}

// The exact stress of the note's test is -10 e_y e_y.
TEST(EnergyBound, seesTheFalseStressesOfInterpolation) {
  // What is lifted reaches as deep as the sides of the coarser mesh are long, however fine the other one is.
  for (const auto& [upper, lower] : {std::array{6, 16}, std::array{12, 10}, std::array{4, 48}}) {
    const Model model =
        compression(upper, lower, elasticMaterial(noteElasticity), CouplingKind::interpolation, upperBody);
    const auto [state, report] = run(model, 1, 1);
    const EnergyBound bound = energyBound(model, state);
    ASSERT_EQ(bound.obstacle, "");
    const Eigen::Vector3d exact = fromCartesian({0, -10, 0});
    double error = 0;
    for (size_t b = 0; b < 2; ++b) {
      Matrix off = state.bodies[b].stress;
      off.colwise() -= exact;
      Matrix strain;
      model.bodies[b].material().elasticStrain(off, strain);
      for (int t = 0; t < model.bodies[b].points(); ++t)
        error += model.bodies[b].weights()[t] * off.col(t).dot(strain.col(t));
    }
    std::cout << "bound over error: " << bound.bound / std::sqrt(error) << "\n";
    EXPECT_GE(bound.bound, std::sqrt(error));
    EXPECT_LE(bound.bound, 1.4 * std::sqrt(error));
  }
}

// ---- overkill
/// Energy norm of the difference of stresses.
double difference(const Model& model, const State& state, const Refined& fine, const State& fineState) {
  double sum = 0;
  for (size_t b = 0; b < model.bodies.size(); ++b) {
    const Body& body = fine.model.bodies[b];
    Matrix off = fineState.bodies[b].stress;
    for (int t = 0; t < body.points(); ++t) off.col(t) -= state.bodies[b].stress.col(fine.parents[b][t]);
    Matrix strain;
    body.material().elasticStrain(off, strain);
    for (int t = 0; t < body.points(); ++t) sum += body.weights()[t] * off.col(t).dot(strain.col(t));
  }
  return std::sqrt(sum);
}

TEST(EnergyBound, holdsUnderWeight) {
  for (const Plane plane : {Plane::stress, Plane::strain}) {
    const Elasticity elasticity{10, 0.3};
    Model model;
    model.bodies.emplace_back(
        "cantilever",
        rectangleMesh({.lower = {0, 0}, .upper = {2, 1}, .cellsX = 8, .cellsY = 4}, Cut::rising),
        elasticMaterial(elasticity, plane),
        Conditions{{{left, 0, constant(0)}, {left, 1, constant(0)}},
                   {},
                   {{alongX, constant(0.05)}, {alongY, constant(-0.1)}}});
    const auto [state, report] = run(model, 1, 1);
    const EnergyBound bound = energyBound(model, state);
    ASSERT_EQ(bound.obstacle, "");
    const Refined fine = refined(model, 3);
    const auto [fineState, fineReport] = run(fine.model, 1, 1);
    const double error = difference(model, state, fine, fineState);
    EXPECT_GE(bound.bound, error);
    EXPECT_LE(bound.bound, 1.1 * error);
  }
}

TEST(EnergyBound, isAboveTheErrorOfRandomScenes) {
  const char* asked = std::getenv("MORTIER_RANDOM_BOUNDS");
  const unsigned count = asked ? static_cast<unsigned>(std::atoi(asked)) : 25;
  unsigned bounded = 0;
  double largest = 0;
  for (unsigned seed = 0; seed < count; ++seed) {
    const Model model = RandomScene(seed).model();
    const auto [state, report] = run(model, 1, 1);
    if (report.status != Status::converged) continue;
    const EnergyBound bound = energyBound(model, state);
    if (!bound.obstacle.empty()) {
      std::cout << "scene " << seed << ": " << bound.obstacle << "\n";
      continue;
    }
    const Refined fine = refined(model, 3);
    const auto [fineState, fineReport] = run(fine.model, 1, 1);
    ASSERT_EQ(fineReport.status, Status::converged) << seed;
    const EnergyBound fineBound = energyBound(fine.model, fineState);
    ASSERT_EQ(fineBound.obstacle, "") << seed;
    const double error = difference(model, state, fine, fineState);
    const double rounding = 1e-12 * (bound.norm + 1e-3);  // moduli and lengths are about 1
    ++bounded;
    EXPECT_LE(error, bound.bound + fineBound.bound + rounding) << "scene " << seed;
    if (error > 1e-6 * bound.norm) largest = std::max(largest, bound.bound / error);
  }
  std::cout << bounded << " scenes, bound over error at most " << largest << "\n";
  EXPECT_GE(bounded, count * 4 / 5);
}

}  // namespace mortier::energy_bound_test
