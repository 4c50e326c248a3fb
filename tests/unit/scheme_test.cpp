// The time schemes, for rates that are given functions of time.
#include "time/scheme.h"

#include <gtest/gtest.h>

#include <cmath>

namespace mortier::scheme_test {

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

TEST(Scheme, exactForRatesBelowItsOrder) {
  for (const Tableau& scheme : {tableau(Scheme::backwardEuler), tableau(Scheme::sdirk2), twoHalfSteps()}) {
    for (int n = 0; n + 1 < scheme.errorOrder; ++n) EXPECT_NEAR(error(scheme, n), 0, rounding);
    EXPECT_GT(std::abs(error(scheme, scheme.errorOrder - 1)), 0.02);
  }
  // Two halves have half the error of one step.
  EXPECT_NEAR(error(twoHalfSteps(), 1), error(tableau(Scheme::backwardEuler), 1) / 2, rounding);
}

}  // namespace mortier::scheme_test
