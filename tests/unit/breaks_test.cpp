#include "time/breaks.h"

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

namespace mortier::breaks_test {

using Times = std::vector<double>;

Times breaksOf(const std::function<double(double)>& datum, double end = 4) {
  return resolve(datum, 0, end).breaks;
}

TEST(Breaks, smoothDataHaveNone) {
  EXPECT_EQ(breaksOf([](double) { return 3.0; }), Times());
  EXPECT_EQ(breaksOf([](double t) { return -10 * t; }), Times());
  EXPECT_EQ(breaksOf([](double t) { return std::sin(40 * t) + 1e6; }), Times());
  EXPECT_EQ(breaksOf([](double t) { return std::exp(-30 * t); }), Times());
  EXPECT_EQ(breaksOf([](double t) { return std::tanh(200 * (t - 1.3)); }), Times());
}

TEST(Breaks, kinksAreFoundAsTheyWereWritten) {
  const auto ramps = [](double t) { return -0.06 * (t <= 1 ? t : t <= 2 ? 1 : t <= 3 ? 3 - t : t - 3); };
  EXPECT_EQ(breaksOf(ramps), (Times{1, 2, 3}));
  EXPECT_EQ(breaksOf([](double t) { return std::abs(t - 1.37) + 2; }), Times{1.37});
  // Twenty reversals of a sawtooth, and where intervals of the search begin.
  const auto saw = [](double t) { return std::asin(std::sin(2 * std::numbers::pi * t)); };
  const Times found = breaksOf(saw, 10);
  ASSERT_EQ(found.size(), 20);
  for (size_t i = 0; i < found.size(); ++i) EXPECT_NEAR(found[i], 0.25 + 0.5 * static_cast<double>(i), 1e-6);
  for (int i = 1; i < 97; ++i) {
    const double kink = 4.0 * i / 97;
    const Times one = breaksOf([kink](double t) { return std::max(t, kink); });
    ASSERT_EQ(one.size(), 1) << kink;
    EXPECT_NEAR(one[0], kink, 1e-11);
  }
}

TEST(Breaks, aJumpIsBetweenTwoNeighbouringNumbers) {
  EXPECT_EQ(breaksOf([](double t) { return t < 1 ? 0.0 : 5.0; }), (Times{std::nextafter(1.0, 0.0), 1}));
  EXPECT_EQ(breaksOf([](double t) { return t <= 0.7 ? t : t + 1e-3; }),
            (Times{0.7, std::nextafter(0.7, 1.0)}));
}

TEST(Breaks, unitsOfTimeAndValueDoNotMatter) {
  for (const double scale : {1e-12, 1.0, 1e9}) {
    const Times found = breaksOf([scale](double t) { return scale * std::min(t, 1.5 * scale); }, 4 * scale);
    ASSERT_EQ(found.size(), 1);
    EXPECT_NEAR(found[0] / scale, 1.5, 1e-8);
  }
}

// ---- samples

constexpr double pi = std::numbers::pi;

TEST(Courses, aStepThatJumpsOverWavesIsSeen) {
  const Course waves = resolve([](double t) { return std::cos(40 * pi * t); }, 0, 1);
  EXPECT_TRUE(waves.resolved);
  EXPECT_NEAR(waves.range, 2, 1e-3);
  // From crest to crest, where every stage of the step sees the same.
  EXPECT_GT(unseen(waves, {1}, 0, 0.05), 0.99);
  EXPECT_GT(unseen(waves, {0.5, 1}, 0, 0.2), 0.9);
  EXPECT_LT(unseen(waves, {0.5, 1}, 0, 0.005), 0.01);
  EXPECT_NEAR(peakBetween(waves, 0, 0.05).height, 1, 1e-3);
  EXPECT_EQ(peakBetween(waves, 0, 0.025).height, 0);
}

TEST(Courses, whatAStepSeesExactlyIsNotMissed) {
  const Course cubic = resolve([](double t) { return t * t; }, 0, 1);
  EXPECT_LT(unseen(cubic, {0.3, 1}, 0, 1), 1e-14);
  EXPECT_NEAR(unseen(cubic, {1}, 0, 1), 0.25, 1e-5);
  const Course constant = resolve([](double) { return 7.0; }, 0, 1);
  EXPECT_EQ(unseen(constant, {1}, 0, 1), 0);
}

TEST(Courses, dataThatCannotBeSampledAreReported) {
  EXPECT_TRUE(resolve([](double t) { return std::sin(2 * pi * 1000 * t); }, 0, 1).resolved);
  EXPECT_FALSE(resolve([](double t) { return std::sin(1e9 * t); }, 0, 1).resolved);
  EXPECT_FALSE(resolve([](double t) { return std::sin(3e5 * t) > 0 ? 1.0 : 0.0; }, 0, 1).resolved);
}

TEST(Courses, aPulseAsShortAsTheFineSamplesIsSeen) {
  constexpr int fine = 100000;
  for (const double width : {1e-4, 1e-5})
    for (int i = 0; i < 20; ++i) {
      const double at = 0.0371 + 0.0467 * i;
      const auto pulse = [=](double t) { return t + std::exp(-std::pow((t - at) / width, 2)); };
      const Course course = resolve(pulse, 0, 1, fine);
      EXPECT_TRUE(course.resolved);
      EXPECT_GT(unseen(course, {0.3, 1}, at - 1e-3, at + 1e-3), 0.3) << width << " at " << at;
    }
}

TEST(Courses, ofATableEveryPulseIsSeen) {
  const std::vector<double> times{0, 0.3, 0.3000001, 0.3000002, 2};
  const auto pulse = [](double t) { return std::max(0.0, 1 - std::abs(t - 0.3000001) / 1e-7); };
  const Course course = tableCourse(pulse, times, 0, 1);
  EXPECT_EQ(course.breaks, (Times{0.3, 0.3000001, 0.3000002}));
  EXPECT_NEAR(unseen(course, {1}, 0, 1), 1, 1e-6);
}

TEST(Courses, theEndsOfTheRunAreNoBreaksOfATable) {
  const Course course = tableCourse([](double t) { return t; }, {0, 0.25, 1, 2}, 0, 1);
  EXPECT_EQ(course.breaks, (Times{0.25}));
  EXPECT_EQ(course.times, (Times{0, 0.25, 1}));
}

}  // namespace mortier::breaks_test
