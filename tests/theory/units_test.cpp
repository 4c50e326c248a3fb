// Units must not matter: not for a bit, where they are powers of two.
#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <iostream>

#include "material/deviatoric.h"
#include "mesh/shape.h"
#include "theory/hard_cases.h"
#include "theory/scenes.h"
#include "time/mesh_error.h"

namespace mortier::units_test {

using namespace hardcases;

std::vector<Compression> scenesForUnits() {
  std::vector<Compression> result;
  for (const Plane plane : {Plane::stress, Plane::strain})
    for (const CouplingKind coupling : couplings)
      for (const Projection projection : projections) {
        Compression scene;
        scene.plane = plane;
        scene.coupling = coupling;
        scene.upperLaw.projection = scene.lowerLaw.projection = projection;
        result.push_back(scene);
      }
  return result;
}

// Powers of four for the stress: the factors of a scaled stiffness are scaled by its square root.
TEST(Units, powersOfTwoChangeNoBit) {
  for (const Compression& scene : scenesForUnits()) {
    const int steps = scene.plane == Plane::stress ? 10 : 13;  // first yield at the end of one, or within one
    const HardResult one = solve(scene.model(), {.end = 1, .steps = steps});
    ASSERT_EQ(one.report.status, Status::converged);
    for (const auto& [length, stress, time] :
         {std::array{0x1p+9, 0x1p-20, 0x1p-3}, std::array{0x1p-7, 0x1p+12, 0x1p+5}}) {
      Compression scaled = scene;
      scaled.length = length;
      scaled.stress = stress;
      scaled.time = time;
      const HardResult other = solve(scaled.model(), {.end = time, .steps = steps});
      EXPECT_EQ(other.report.iterations, one.report.iterations);
      EXPECT_EQ(other.report.factorisations, one.report.factorisations);
      for (size_t b = 0; b < 2; ++b) {
        EXPECT_EQ(other.state.bodies[b].displacement, length * one.state.bodies[b].displacement);
        EXPECT_EQ(other.state.bodies[b].stress, stress * one.state.bodies[b].stress);
        EXPECT_EQ(other.state.bodies[b].viscoplasticStrain, one.state.bodies[b].viscoplasticStrain);
      }
      EXPECT_EQ(other.state.contactForce[0], length * stress * one.state.contactForce[0]);
      EXPECT_EQ(other.report.worst.forceBalance, one.report.worst.forceBalance);
      EXPECT_EQ(other.report.worst.materialResidual, one.report.worst.materialResidual);
      EXPECT_EQ(other.report.worst.complementarity, one.report.worst.complementarity);
    }
  }
}

// In space the gaps between surfaces are a part of the estimate as well.
TEST(Units, ofSpaceDoNotChangeTheEstimatedError) {
  const auto solved = [](double length, double stress) {
    const auto still = [](const SpacePoint&, double) { return 0.0; };
    const auto pressure = [=](const SpacePoint& x, double t) {
      return -stress * t * (1 + x.x() * x.y() / (length * length));
    };
    const auto box = [&](double lowest, int cells) {
      return cuboidMesh(
          {{0, 0, lowest * length}, {length, length, (lowest + 1) * length}, {cells, cells, cells}});
    };
    const auto material = elasticMaterial({100 * stress, 0.3}, Plane::none);
    constexpr int bottom = 1;
    constexpr int top = 3;
    Model model;
    model.bodies.emplace_back("upper", box(0, 2), material,
                              Conditions{{{4, alongX, still}, {5, alongY, still}}, {{top, alongZ, pressure}}},
                              1);
    model.bodies.emplace_back(
        "lower", box(-1, 3), material,
        Conditions{{{4, alongX, still}, {5, alongY, still}, {bottom, alongZ, still}}, {}}, 1);
    addInterface(model, {{0, bottom}, {1, top}, CouplingKind::weighted});
    const auto [state, report] = scenes::run(model, 1, 1);
    EXPECT_EQ(report.status, Status::converged) << report.reason;
    double sum = 0;
    for (const ErrorEstimate& estimate : MeshErrorEstimator(model)(state)) sum += estimate.error.sum();
    return sum / (stress * std::pow(length, 3));
  };
  const double one = solved(1, 1);
  EXPECT_NEAR(solved(1e3, 1e-6), one, 1e-9 * one);
  EXPECT_NEAR(solved(1e-3, 1e6), one, 1e-9 * one);
}

}  // namespace mortier::units_test
