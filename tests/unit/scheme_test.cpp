// The embedded error estimates of docs/theory.md, for rates that are given functions of time.
#include "time/scheme.h"

#include <gtest/gtest.h>

#include <cmath>

namespace mortier {
namespace {

constexpr double rounding = 1e-15;

double power(double t, int n) {
  return n == 0 ? 1 : std::pow(t, n);
}

/// What a step from 0 to 1 makes of the rate t^n, minus the integral.
double error(const Tableau& tableau, int n) {
  const Stage& last = tableau.stages.back();
  double sum = last.diagonal * power(last.time, n);
  for (size_t j = 0; j < last.before.size(); ++j) sum += last.before[j] * power(tableau.stages[j].time, n);
  return sum - 1.0 / (n + 1);
}

double estimate(const Tableau& tableau, int n) {
  double sum = tableau.errorWeights[0] * power(0, n);
  for (size_t j = 0; j < tableau.stages.size(); ++j)
    sum += tableau.errorWeights[j + 1] * power(tableau.stages[j].time, n);
  return sum;
}

TEST(Scheme, estimatesOfBackwardEulerAreItsErrorWhereTheRateIsLinear) {
  for (const Tableau& scheme : {tableau(Scheme::backwardEuler), twoHalfSteps()}) {
    EXPECT_NEAR(error(scheme, 0), 0, rounding);
    EXPECT_NEAR(estimate(scheme, 0), 0, rounding);
    EXPECT_GT(error(scheme, 1), 0.1);
    EXPECT_NEAR(estimate(scheme, 1), error(scheme, 1), rounding);
  }
  // Two halves have half the error of one step.
  EXPECT_NEAR(error(twoHalfSteps(), 1), error(tableau(Scheme::backwardEuler), 1) / 2, rounding);
}

TEST(Scheme, estimateOfSdirk2SeesTheFirstRateThatItMisses) {
  const Tableau scheme = tableau(Scheme::sdirk2);
  for (const int exact : {0, 1}) {
    EXPECT_NEAR(error(scheme, exact), 0, rounding);
    EXPECT_NEAR(estimate(scheme, exact), 0, rounding);
  }
  // c = 0.1143 stands for the 0.0286 of a rate that is given.
  EXPECT_NEAR(estimate(scheme, 2) / error(scheme, 2), 0.1143 / 0.0286, 5e-3);
}

}  // namespace
}  // namespace mortier
