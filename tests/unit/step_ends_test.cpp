#include "time/step_ends.h"

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

namespace mortier::step_ends_test {

constexpr double pi = std::numbers::pi;
constexpr double missed = 0.01;

TimePlan planOf(std::vector<Course> data) {
  TimePlan plan{.end = 1, .scheme = Scheme::sdirk2};
  plan.data = std::move(data);
  return plan;
}

std::vector<double> endsOf(const TimePlan& plan, double k) {
  const StepEnds ends(plan, 0);
  std::vector<double> times;
  for (double t = ends.next(0, k, missed); t < plan.end; t = ends.next(t, k, missed)) times.push_back(t);
  return times;
}

// cos is missed by 1e-4 of its range at most where steps end on its peaks within 0.01 rad.
TEST(StepEnds, areOnPeaksOfTheData) {
  constexpr int waves = 3;
  for (const double phase : {0.0, 0.4, 1.1, 2.9}) {
    const TimePlan plan =
        planOf({resolve([=](double t) { return std::cos(2 * pi * waves * t + phase); }, 0, 1)});
    const std::vector<double> ends = endsOf(plan, 0.037);
    for (int i = 1; i <= 2 * waves; ++i) {
      const double peak = (i * pi - phase) / (2 * pi * waves);
      if (peak <= 0 || peak >= 1) continue;
      double nearest = 1;
      for (const double t : ends) nearest = std::min(nearest, std::abs(t - peak));
      EXPECT_LT(nearest * 2 * pi * waves, 0.02) << "phase " << phase << ", peak at " << peak;
    }
    EXPECT_LT(ends.size(), 1 / 0.037 + 4 * waves);
  }
}

// Somewhere such waves peak all the time.
TEST(StepEnds, ofWavesThatMoveAreAsFewAsOfOthers) {
  std::vector<Course> data;
  for (int place = 0; place < 40; ++place)
    data.push_back(resolve([=](double t) { return std::cos(2 * pi * (3 * t - place / 40.0)); }, 0, 1));
  const auto moving = endsOf(planOf(data), 0.037).size();
  EXPECT_LT(moving, 1.2 * static_cast<double>(endsOf(planOf({data[0]}), 0.037).size()));
}

TEST(StepEnds, missNoPulseAndPassNoBreak) {
  const auto pulse = [](double t) { return std::min(t, 0.3) + std::exp(-std::pow((t - 0.6) / 1e-3, 2)); };
  TimePlan plan = planOf({resolve(pulse, 0, 1, 10000)});
  plan.breaks = {0.3};
  const std::vector<double> ends = endsOf(plan, 0.5);
  const auto within = [&](double a, double b) {
    return std::count_if(ends.begin(), ends.end(), [&](double t) { return a <= t && t <= b; });
  };
  EXPECT_EQ(within(0.3, 0.3), 1);
  EXPECT_GE(within(0.597, 0.603), 4);
  const StepEnds of(plan, 0);
  EXPECT_TRUE(of.isBreak(0.3));
  EXPECT_FALSE(of.isBreak(0.6));
  EXPECT_EQ(of.breakAfter(0.1), 0.3);
  EXPECT_EQ(of.breakAfter(0.3), 1);
}

}  // namespace mortier::step_ends_test
