// The course of an error: weights of a step, and the largest integral of a rate that obeys its sums.
#include "bound/flowing_body.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <random>

namespace mortier::error_course_test {

TEST(StepWeights, areIntegralsOfPowersOverTheGrowth) {
  for (const auto& [rho0, rho1] :
       {std::array{1., 1.}, {2., 2.0001}, {1., 1.0099}, {1., 1.0101}, {0.5, 2.}, {1., 30.}}) {
    const StepWeights weights(rho0, rho1);
    EXPECT_FALSE(weights.fromRest());
    constexpr int parts = 20000;
    std::array<double, 3> sums{};
    double root = 0;
    for (int i = 0; i < parts; ++i) {
      const double t = (i + 0.5) / parts;
      const double mu = 1 / (rho0 + t * (rho1 - rho0));
      EXPECT_NEAR(weights.at(t), mu, 1e-14 * mu);
      for (int j = 0; j < 3; ++j) sums[j] += std::pow(t, j) * mu / parts;
      root += std::sqrt(mu) / parts;
    }
    for (int j = 0; j < 3; ++j) EXPECT_NEAR(weights.moment(j), sums[j], 1e-6 * sums[j]);
    EXPECT_NEAR(weights.root(), root, 1e-6 * root);
    EXPECT_DOUBLE_EQ(weights.length(), (rho0 + rho1) / 2);
  }
  const StepWeights rest(0, 1);
  EXPECT_TRUE(rest.fromRest());
  EXPECT_TRUE(std::isinf(rest.moment(0)));
  EXPECT_EQ(rest.moment(1), 1);
  EXPECT_EQ(rest.moment(2), 0.5);
  EXPECT_EQ(rest.root(), 2);
}

/// Rates that obey the sums at the ends of all steps are never above, and one comes near.
TEST(ErrorCourse, hasTheLargestIntegralOfARate) {
  std::mt19937 random(5);
  std::uniform_real_distribution<double> uniform;
  for (int i = 0; i < 50; ++i) {
    ErrorCourse course;
    const double lambda = 0.1 + uniform(random);
    const int steps = 2 + i % 5;
    std::vector<double> lengths(steps);
    std::vector<double> sums(steps);
    double length = 0;
    double misfit = 0;
    double drift = 0;
    for (int n = 0; n < steps; ++n) {
      const double factor = 1 + uniform(random);
      const StepWeights weights = course.weights(factor);
      const double timeStep = 0.1 + uniform(random);
      const double delta = n == 0 ? 0 : std::pow(uniform(random), 3);
      const double change = n < 2 ? 0 : 0.3 * uniform(random);
      course.add(weights, factor, timeStep, delta, change);
      lengths[n] = timeStep * weights.length();
      length += lengths[n];
      misfit += delta;
      drift += change * weights.root();
      sums[n] = misfit + drift * (std::sqrt(2 * misfit) + drift);
    }
    EXPECT_NEAR(course.lengths.back(), length, 1e-12 * length);
    EXPECT_NEAR(course.energyNorm(), std::sqrt(course.growth) * (std::sqrt(2 * misfit) + drift), 1e-12);
    const double bound = course.rateIntegral(lambda);
    // Shares of the sums, each as it pleases, then made to obey; the best of many, by climbing.
    const auto integral = [&](const std::vector<double>& rates) {
      double all = 0;
      double used = 0;
      for (int n = 0; n < steps; ++n) {
        const double share = std::min(rates[n], sums[n] - used);
        used += std::max(0.0, share);
        all += std::sqrt(lengths[n] * std::max(0.0, share) / lambda);
      }
      return all;
    };
    std::vector<double> best(steps, 0.0);
    double most = 0;
    for (int k = 0; k < 4000; ++k) {
      std::vector<double> rates = best;
      for (double& rate : rates)
        rate = k % 4 == 0 ? sums.back() * uniform(random) : rate * (0.9 + 0.2 * uniform(random));
      const double all = integral(rates);
      EXPECT_LE(all, bound * (1 + 1e-12));
      if (all <= most) continue;
      most = all;
      best = rates;
    }
    EXPECT_GE(most, 0.97 * bound);
  }
}

}  // namespace mortier::error_course_test
