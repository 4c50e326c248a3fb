// The arcs behind polygonal lines.
#include "contact/smooth_part.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <numbers>
#include <random>

namespace mortier::arcs_test {

constexpr double pi = std::numbers::pi;

/// Nodes of a curve at parameters that are not equally far from each other, from `begin` to `end`.
template <class Curve>
std::vector<Point> nodesOf(int elements, double begin, double end, Curve curve, unsigned seed = 1) {
  std::mt19937 random(seed);
  std::uniform_real_distribution<double> width(1, 2);
  std::vector<double> t{0};
  for (int i = 0; i < elements; ++i) t.push_back(t.back() + width(random));
  std::vector<Point> points;
  for (const double each : t) points.push_back(curve(begin + (end - begin) * each / t.back()));
  return points;
}

auto circle(double radius, const Point& centre = {3, -7}) {
  return [=](double t) { return Point(centre + radius * Point(std::cos(t), std::sin(t))); };
}

int known(const std::vector<Arc>& arcs) {
  return static_cast<int>(std::count_if(arcs.begin(), arcs.end(), [](const Arc& arc) { return arc.known; }));
}

// A flat side of five nodes that goes on in an arc whose first nodes are off the tangent by less than what
// coordinates of seven digits have: with the middles of a geometry it is flat.
TEST(Arcs, aStraightSideBesideAnArcIsStraight) {
  constexpr double radius = 2;
  std::vector<Point> points{{-3, 0}, {-2, 0}, {-1, 0}, {0, 0}, {1, 0}};
  const size_t flat = points.size() - 1;
  const auto onArc = [](double angle) {
    return Point(1 + radius * std::sin(angle), radius - radius * std::cos(angle));
  };
  std::vector<double> angles{0};
  for (double angle = 1e-3; angle < 1.5; angle *= 2) angles.push_back(angle);
  for (size_t i = 1; i < angles.size(); ++i) points.push_back(onArc(angles[i]));
  std::vector<Point> middles;
  for (size_t e = 0; e < flat; ++e) middles.emplace_back((points[e] + points[e + 1]) / 2);
  for (size_t i = 1; i < angles.size(); ++i) middles.push_back(onArc((angles[i - 1] + angles[i]) / 2));
  const std::vector<Arc> arcs = arcsOf(points, false, middles);
  for (size_t e = 0; e < flat; ++e) EXPECT_LE(std::abs(arcs[e].curvature), 1e-12) << e;
  for (size_t e = flat; e < arcs.size(); ++e) EXPECT_NEAR(arcs[e].curvature, 1 / radius, 1e-6) << e;
}

TEST(Arcs, circlesAreFoundWhateverTheirSizeAndSense) {
  constexpr double rounding = 1e-9;  // of the curvature: R^2/h^2 times that of the places
  for (const double radius : {1e-6, 1.0, 20.05, 1e6})
    for (const double angle : {0.01, 1.0, 3.1, 5.0, -0.5, -6.0})
      for (const int elements : {3, 4, 17, 400}) {
        const auto points = nodesOf(elements, 0.3, 0.3 + angle, circle(radius, {3 * radius, -radius}));
        const std::vector<Arc> arcs = arcsOf(points, false);
        ASSERT_EQ(known(arcs), elements) << radius << " " << angle << " " << elements;
        for (const Arc& arc : arcs)
          EXPECT_NEAR(arc.curvature * radius, angle > 0 ? 1 : -1, angle * angle < 1e-3 ? 1e-7 : rounding);
      }
  for (const int elements : {4, 33, 1000}) {
    auto points = nodesOf(elements, 0, 2 * pi, circle(2));
    points.back() = points.front();
    const std::vector<Arc> arcs = arcsOf(points, true);
    EXPECT_EQ(known(arcs), elements);
    for (const Arc& arc : arcs) EXPECT_NEAR(arc.curvature, 0.5, rounding);
  }
}

TEST(Arcs, polygonsOfFewEdgesAreReported) {
  constexpr double least = pi / 6;
  constexpr double rounding = 1e-9;
  const auto polygon = [](int edges, double ratio) {
    std::vector<Point> points;
    for (int i = 0; i <= edges; ++i) {
      const double t = 2 * pi * (i % edges) / edges;
      points.emplace_back(3 + std::cos(t), ratio * std::sin(t));
    }
    return points;
  };
  for (const int edges : {5, 6, 8, 11})
    EXPECT_NEAR(turnOfPolygon(polygon(edges, 1), true, least), 2 * pi / edges, rounding) << edges;
  EXPECT_EQ(turnOfPolygon(polygon(13, 1), true, least), 0);
  EXPECT_EQ(turnOfPolygon(polygon(9, 0.6), true, least), 0);  // no circle
  EXPECT_EQ(turnOfPolygon({{0, 0}, {1, 0}, {2, 0}, {2, 1}, {2, 2}}, false, least), 0);
}

TEST(Arcs, threeNodesTellNothing) {
  EXPECT_EQ(known(arcsOf(nodesOf(2, 0, 1, circle(1)), false)), 0);
  EXPECT_EQ(known(arcsOf({{0, 0}, {1, 0.1}}, false)), 0);
  EXPECT_EQ(known(arcsOf({{0, 0}, {1, 0}, {0, 1}, {0, 0}}, true)), 0);
}

// A slot: straight, half a circle, straight.
TEST(Arcs, linesOfSeveralCurves) {
  std::vector<Point> points;
  for (int i = -6; i < 0; ++i) points.emplace_back(i, -2);
  for (int i = 0; i <= 12; ++i) points.push_back(circle(2, {0, 0})(-pi / 2 + pi * i / 12));
  for (int i = 1; i <= 6; ++i) points.emplace_back(-i, 2);
  const std::vector<Arc> arcs = arcsOf(points, false);
  EXPECT_EQ(known(arcs), 24);
  for (int e = 0; e < 24; ++e) EXPECT_NEAR(arcs[e].curvature, e < 6 || e >= 18 ? 0 : 0.5, 1e-12) << e;
}

// Nodes off the circle by more than a millionth of the radius, and a curve that is none.
TEST(Arcs, whatIsNoCircleIsNotKnown) {
  std::mt19937 random(2);
  std::uniform_real_distribution<double> off(-1, 1);
  for (const double noise : {1e-9, 1e-5}) {
    auto points = nodesOf(40, 0, 2, circle(1, {0, 0}));
    for (Point& p : points) p *= 1 + noise * off(random);
    if (noise < 1e-6)
      EXPECT_EQ(known(arcsOf(points, false)), 40);
    else
      EXPECT_LT(known(arcsOf(points, false)), 8);  // four nodes may be on a circle by chance
  }
  const auto ellipse = [](double t) { return Point(2 * std::cos(t), std::sin(t)); };
  const std::vector<Arc> coarse = arcsOf(nodesOf(20, 0.2, 2.5, ellipse), false);
  EXPECT_LT(known(coarse), 5);
  for (const Arc& arc : coarse) EXPECT_GT(arc.curvature, 0.2);
  EXPECT_EQ(known(arcsOf(nodesOf(2000, 0.2, 2.5, ellipse), false)),
            2000);  // piece by piece, where it is fine enough
}

TEST(Arcs, distanceAlongALine) {
  constexpr double rounding = 1e-14;
  std::mt19937 random(3);
  std::uniform_real_distribution<double> value(0, 1);
  for (int trial = 0; trial < 1000; ++trial) {
    const double radius = std::pow(10, 6 * value(random) - 3);
    const double begin = 7 * value(random);
    const double angle = 1.5 * value(random);
    const Point centre = radius * Point(value(random), value(random));
    const Point a = circle(radius, centre)(begin);
    const Point b = circle(radius, centre)(begin + angle);
    const Point x = a + value(random) * (b - a);
    const double turn = begin + angle / 2 + 0.4 * (value(random) - 0.5);
    const Point n(std::cos(turn), std::sin(turn));
    const double out = distanceToArc(a, b, 1 / radius, x, n);
    EXPECT_NEAR((x + out * n - centre).norm() / radius, 1, rounding);
    EXPECT_LE(std::abs(out), 1.2 * sagitta((b - a).norm(), 1 / radius) * (1 + angle * angle / 4) + rounding);
    // A hole: the body on the other side.
    EXPECT_NEAR(distanceToArc(b, a, -1 / radius, x, -n), -out, rounding * radius);
  }
  EXPECT_EQ(distanceToArc({0, 0}, {1, 0}, 0, {0.3, 0}, {0, -1}), 0);
  EXPECT_NEAR(distanceToArc({0, 0}, {1, 0}, 1e-9, {0.5, 0}, {0, -1}), 1.25e-10, 1e-24);
}

}  // namespace mortier::arcs_test
