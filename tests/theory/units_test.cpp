// Units must not matter: not for a bit, where they are powers of two, and not for the number of iterations.
#include <gtest/gtest.h>

#include <array>
#include <iostream>

#include "theory/hard_cases.h"

namespace mortier::units_test {

using namespace hardcases;

std::vector<Compression> scenesForUnits() {
  std::vector<Compression> result;
  for (const CouplingKind coupling : couplings)
    for (const Projection projection : projections) {
      Compression scene;
      scene.coupling = coupling;
      scene.upperLaw.projection = scene.lowerLaw.projection = projection;
      result.push_back(scene);
    }
  return result;
}

// Powers of four for the stress: the factors of a scaled stiffness are scaled by its square root.
TEST(Units, powersOfTwoChangeNoBit) {
  for (const Compression& scene : scenesForUnits()) {
    const HardResult one = solve(scene.model(), {.end = 1, .steps = 10});
    ASSERT_EQ(one.report.status, Status::converged);
    for (const auto& [length, stress, time] :
         {std::array{0x1p+9, 0x1p-20, 0x1p-3}, std::array{0x1p-7, 0x1p+12, 0x1p+5}}) {
      Compression scaled = scene;
      scaled.length = length;
      scaled.stress = stress;
      scaled.time = time;
      const HardResult other = solve(scaled.model(), {.end = time, .steps = 10});
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

TEST(Units, millimetresAndMegapascalsTakeAsManyIterations) {
  for (const Compression& metres : scenesForUnits()) {
    Compression millimetres = metres;
    millimetres.length = 1e3;
    millimetres.stress = 1e-6;
    for (const int steps : {10, 13}) {
      const RunReport one = solve(metres.model(), {.end = 1, .steps = steps}).report;
      const RunReport other = solve(millimetres.model(), {.end = 1, .steps = steps}).report;
      std::cout << nameOf(metres.coupling) << ", " << nameOf(metres.upperLaw.projection) << ", N = " << steps
                << ": " << one.iterations << " and " << other.iterations << " iterations\n";
      ASSERT_EQ(other.status, Status::converged);
      EXPECT_EQ(other.iterations, one.iterations);
      EXPECT_EQ(other.maxIterationsInAStep, one.maxIterationsInAStep);
    }
  }
}

}  // namespace mortier::units_test
