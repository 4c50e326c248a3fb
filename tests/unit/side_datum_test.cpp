// Data on sides and triangles: moments, and bounds of what is beside linear functions, whatever is between
// the points of a quadrature.
#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

#include "bound/side_datum.h"
#include "scene/expression.h"

namespace mortier::side_datum_test {

Datum formula(const std::string& text) {
  return finiteValue(parseExpression(text, "here"));
}
SideDatum unit(const std::string& text) {
  return onSide(formula(text), {0, 0}, {1, 0}, 0.5);
}

TEST(SideDatum, hasTheMomentsAndTheDistanceFromALine) {
  const SideDatum linear = unit("3 - 2*x + t");
  EXPECT_TRUE(linear.linear());
  EXPECT_NEAR(linear.moments[0], 3.5 / 2 - 2. / 6, 1e-14);
  EXPECT_NEAR(linear.moments[1], 3.5 / 2 - 2. / 3, 1e-14);
  const SideDatum square = unit("10 + x^2");
  EXPECT_FALSE(square.linear());
  EXPECT_NEAR(square.moments[1], 5 + 0.25, 1e-13);
  const double off = std::sqrt(1. / 30);  // of x^2 - x
  EXPECT_GE(square.off, off * (1 - 1e-12));
  EXPECT_LE(square.off, 1.02 * off);
  EXPECT_GE(square.slope, std::sqrt(1. / 3) * (1 - 1e-12));
  EXPECT_LE(square.slope, 1.1 * std::sqrt(1. / 3));
  const SideDatum wave = unit("sin(8*pi*x)");
  EXPECT_NEAR(wave.moments[0], 1 / (8 * std::numbers::pi), 1e-12);
  EXPECT_GE(wave.off, std::sqrt(0.5) * (1 - 1e-12));
  EXPECT_LE(wave.off, 1.02 * std::sqrt(0.5));
  EXPECT_LE(wave.momentError, 1e-11);
}

TEST(SideDatum, seesPeaksAndJumps) {
  const SideDatum peak = unit("exp(-((x - 0.3717171)/1e-4)^2)");
  const double integral = std::sqrt(std::numbers::pi) * 1e-4;
  EXPECT_NEAR(peak.moments[0] + peak.moments[1], integral, 1e-3 * integral);
  EXPECT_GE(peak.off * peak.off, 0.99 * std::sqrt(std::numbers::pi / 2) * 1e-4);
  const SideDatum jump = unit("x < 0.3 ? 1 : 2");
  ASSERT_EQ(jump.jumps.size(), 1U);
  EXPECT_NEAR(jump.jumps[0], 0.3, 1e-9);
  EXPECT_NEAR(jump.moments[0] + jump.moments[1], 1.7, 1e-9);
  EXPECT_GE(jump.slope, 1e3);
  const SideDatum kink = unit("abs(x - 0.3)");
  EXPECT_NEAR(kink.moments[0] + kink.moments[1], 0.29, 1e-10);
  EXPECT_LE(kink.slope, 2);
  EXPECT_FALSE(unit("1/(x - 0.3)").known);
}

TEST(TriangleDatum, projectsAndBoundsTheRest) {
  const std::array<Point, 3> x{Point(0, 0), Point(1, 0), Point(0, 1)};
  const DataOnTriangles data(
      {formula("1 + 2*x - y"), formula("x^2"), formula("x < 0.25 ? 1 : 0"), formula("exp(2*x)")}, 0, 1);
  const TriangleDatum linear = data.on(0, x);
  EXPECT_EQ(linear.rest, 0);
  EXPECT_NEAR(linear.linear[1], 3, 1e-13);
  const TriangleDatum square = data.on(1, x);
  // x^2 - (0.8 x - 0.1), whose mean square is 1/300.
  EXPECT_NEAR(square.linear[0], -0.1, 1e-12);
  EXPECT_NEAR(square.linear[1], 0.7, 1e-12);
  const double rest = std::sqrt(2 * (1. / 30 - 1.6 / 20 + 0.84 / 12 - 0.16 / 6 + 0.01 / 2));
  EXPECT_GE(square.rest, rest * (1 - 1e-12));
  EXPECT_LE(square.rest, 1.3 * rest);
  EXPECT_GE(data.on(2, x).distanceTo(1), std::sqrt(0.5625) * (1 - 1e-9));
  // The square of x^2 - 1/9 has the mean 1/15 - 2/54 + 1/81.
  const double distance = std::sqrt(1. / 15 - 1. / 27 + 1. / 81);
  EXPECT_GE(square.distanceTo(1. / 9), distance * (1 - 1e-12));
  EXPECT_LE(square.distanceTo(1. / 9), 1.05 * distance);
}

TEST(TriangleDatum, boundsTheErrorOfItsIntegrals) {
  const std::array<Point, 3> x{Point(0, 0), Point(1, 0), Point(0, 1)};
  const auto missed = [&](const std::string& text, double mean) {
    const TriangleDatum datum = DataOnTriangles({formula(text)}, 0, 1).on(0, x);
    const auto& [a, b, c] = datum.linear;
    EXPECT_LE(std::abs((a + b + c) / 3 - mean), datum.error + 1e-14) << text;
    return datum.error;
  };
  EXPECT_LE(missed("1 + x^4 - x*y^3", 1 + 1. / 15 - 1. / 60), 1e-12);
  const double exponential = missed("exp(2*x)", (std::exp(2) - 3) / 2);
  EXPECT_GT(exponential, 0);
  EXPECT_LE(exponential, 1e-6);
  EXPECT_LE(missed("x < 0.3 ? 1 : 0", 1 - 0.49), 0.1);
  // All points of the rule on the whole triangle miss it.
  missed("exp(-((x - 0.2)^2 + (y - 0.2)^2)/1e-4)", 2 * std::numbers::pi * 1e-4);
}

}  // namespace mortier::side_datum_test
