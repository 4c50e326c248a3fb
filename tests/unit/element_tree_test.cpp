// What is near a point of a line, against trying everything.
#include "contact/element_tree.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <random>

namespace mortier::element_tree_test {

std::vector<Point> arc(int elements, double radius) {
  std::vector<Point> points;
  for (int i = 0; i <= elements; ++i)
    points.emplace_back(radius * std::cos(3.0 * i / elements), radius * std::sin(3.0 * i / elements));
  return points;
}

double distanceTo(const Point& a, const Point& b, const Point& x) {
  const double xi = std::clamp((x - a).dot(b - a) / (b - a).squaredNorm(), 0.0, 1.0);
  return (a + xi * (b - a) - x).norm();
}

TEST(ElementTree, findsTheNearestElementWithFewVisits) {
  std::mt19937 random(1);
  std::normal_distribution<double> value(0, 1);
  for (const int elements : {1, 7, 8, 9, 100, 10000})
    for (const double off : {1e-3, 1.0}) {
      const std::vector<Point> line = arc(elements, 1);
      const ElementTree tree(line);
      int most = 0;
      for (int trial = 0; trial < 50; ++trial) {
        const double at = 3 * std::abs(std::remainder(value(random), 1.0)) * 2;
        const Point x = Point(std::cos(at), std::sin(at)) + off * Point(value(random), value(random));
        double expected = std::numeric_limits<double>::infinity();
        for (int e = 0; e < elements; ++e) expected = std::min(expected, distanceTo(line[e], line[e + 1], x));
        double nearest = std::numeric_limits<double>::infinity();
        int visits = 0;
        tree.near(x, nearest, [&](int e) {
          ++visits;
          nearest = std::min(nearest, distanceTo(line[e], line[e + 1], x));
        });
        EXPECT_EQ(nearest, expected);
        if (off < 1) most = std::max(most, visits);
      }
      EXPECT_LE(most, 100) << elements;
    }
}

TEST(ElementTree, farthestNode) {
  const std::vector<Point> line = arc(40, 1);
  EXPECT_EQ(farthestNode(line, {{1, 0}, {1, 0.1}}), 39);  // the last node of a closed line is its first
}

}  // namespace mortier::element_tree_test
