// The hard cases must converge within the limits of their certificate.
#include "theory/hard_cases.h"

#include <gtest/gtest.h>

#include <iostream>

namespace mortier {
namespace {

using namespace hardcases;

void expectWithinLimits(const std::string& family) {
  int count = 0;
  for (const HardCase& hard : hardCases()) {
    if (hard.slow || hard.open || hard.name.find(family) != 0) continue;
    SCOPED_TRACE(hard.name);
    const HardResult result = solve(hard.model(), hard.plan);
    const Certificate& worst = result.report.worst;
    EXPECT_EQ(result.report.status, Status::converged) << result.report.reason;
    EXPECT_LT(worst.forceBalance, forceBalanceLimit);
    EXPECT_LT(worst.materialResidual, materialResidualLimit);
    EXPECT_LT(worst.complementarity, complementarityLimit);
    ++count;
  }
  EXPECT_GT(count, 0);
  std::cout << count << " cases\n";
}

TEST(HardCases, coarseNonmortar) {
  expectWithinLimits("coarse nonmortar");
}
TEST(HardCases, data) {
  expectWithinLimits("data");
}
TEST(HardCases, geometry) {
  expectWithinLimits("geometry");
}
TEST(HardCases, eccentricLoad) {
  expectWithinLimits("eccentric");
}

}  // namespace
}  // namespace mortier
