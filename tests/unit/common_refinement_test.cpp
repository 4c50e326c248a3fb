// Which points of two lines face each other: a property of the lines, not of how they are cut.
#include "contact/common_refinement.h"

#include <gtest/gtest.h>

#include <cmath>

#include "mesh/boundary_line.h"

namespace mortier::common_refinement_test {

constexpr double rounding = 1e-13;

/// A line through points, its body to the left.
BoundaryLine lineThrough(const std::vector<Point>& points, bool closed = false) {
  BoundaryLine line;
  line.points = points;
  line.closed = closed;
  for (size_t i = 0; i < points.size(); ++i) line.nodes.push_back(static_cast<int>(i));
  if (closed) {
    line.nodes.push_back(0);
    line.points.push_back(points.front());
  }
  return line;
}

/// Each side cut into so many edges.
std::vector<Point> cut(const std::vector<Point>& corners, int edges) {
  std::vector<Point> points{corners.front()};
  for (size_t i = 1; i < corners.size(); ++i)
    for (int k = 1; k <= edges; ++k)
      points.emplace_back(corners[i - 1] + (corners[i] - corners[i - 1]) * k / edges);
  return points;
}

std::vector<Point> circle(int edges, const Point& centre, double radius) {
  std::vector<Point> points;
  for (int i = 0; i < edges; ++i) {
    const double angle = 2 * M_PI * i / edges;
    points.emplace_back(centre + radius * Point(std::cos(angle), std::sin(angle)));
  }
  return points;
}

TEST(CommonRefinement, aWholeCircleFacesALineOfAnyLengthAndAnyCut) {
  const SmoothPart part = smoothParts(lineThrough(circle(96, {0, 1.01}, 1), true)).front();
  for (const double half : {0.9, 1.05, 2.0, 3.0, 5.0, 100.0})
    for (const int edges : {1, 2, 10, 100}) {
      const MortarLine line(lineThrough(cut({{half, 0}, {-half, 0}}, edges)));
      const CommonRefinement refinement(part, line);
      // Up to 60 degrees from the lowest point, in whole edges.
      EXPECT_NEAR(refinement.length(), 32 * part.s[1], rounding) << half << ", " << edges;
      EXPECT_TRUE(refinement.corners().empty());
      for (const Segment& piece : refinement.segments()) {
        const FacingPair facing = refinement.pairAt(piece, (piece.begin + piece.end) / 2);
        EXPECT_LE((facing.normal - Point(0, -1)).norm(), rounding);
        EXPECT_GT(facing.distance, 0);
      }
    }
}

TEST(CommonRefinement, edgesShorterThanAPenetrationHideNothing) {
  // A punch with edges rounded by 0.02, 0.1 deep in a line.
  std::vector<Point> punch{{-0.5, 1}};
  for (int i = 0; i <= 8; ++i)
    punch.emplace_back(-0.48 - 0.02 * std::cos(i * M_PI / 16), -0.08 - 0.02 * std::sin(i * M_PI / 16));
  for (int i = 8; i >= 0; --i)
    punch.emplace_back(0.48 + 0.02 * std::cos(i * M_PI / 16), -0.08 - 0.02 * std::sin(i * M_PI / 16));
  punch.emplace_back(0.5, 1);
  const SmoothPart part = smoothParts(lineThrough(cut({{1.5, 0}, {-1.5, 0}}, 72))).front();
  const MortarLine line{lineThrough(punch)};
  for (const std::optional<double> share :
       {std::optional<double>{}, std::optional(0.0), std::optional(1.0)}) {
    const CommonRefinement refinement(part, line, share);
    double deepest = 0;
    for (const Segment& piece : refinement.segments())
      deepest = std::min(deepest, refinement.pairAt(piece, (piece.begin + piece.end) / 2).distance);
    EXPECT_NEAR(deepest, -0.1, 0.002);  // rays are not all normal to it
    EXPECT_GE(refinement.length(), 0.93);
  }
}

// Which side is nonmortar changes nothing: the normal of the slope, at the corner alone.
TEST(CommonRefinement, aCornerOnASlopeHasTheNormalOfTheSlope) {
  for (const double degrees : {10.0, 30.0, 50.0, -20.0}) {
    const double angle = degrees * M_PI / 180;
    const Point along(std::cos(angle), std::sin(angle));
    const Point up(-along.y(), along.x());
    const auto slope = cut({3 * along, -3 * along}, 23);  // its body below
    const std::vector<Point> square{Point(degrees > 0 ? -1 : 0, 0), Point(degrees > 0 ? 0 : 1, 0),
                                    Point(degrees > 0 ? 0 : 1, 1), Point(degrees > 0 ? -1 : 0, 1)};
    const auto corners = smoothParts(lineThrough(square, true));
    const MortarLine below{lineThrough(slope)};
    int found = 0;
    for (const SmoothPart& part : corners) {
      const CommonRefinement refinement(part, below);
      for (const CornerContact& corner : refinement.corners()) {
        if (part.points[corner.vertex].norm() > rounding) continue;  // another one, above
        ++found;
        EXPECT_LE((refinement.directionAt(corner.vertex) + up).norm(), rounding) << degrees;
        EXPECT_EQ(corner.weight, 1);
      }
    }
    EXPECT_GE(found, 1) << degrees;
    const SmoothPart ground = smoothParts(lineThrough(slope)).front();
    const MortarLine above(lineThrough(square, true));
    const CommonRefinement refinement(ground, above);
    ASSERT_EQ(refinement.corners().size(), 1U) << degrees;
    const CornerContact& corner = refinement.corners().front();
    EXPECT_LE((refinement.directionAt(corner.vertex) - up).norm(), rounding);
    EXPECT_NEAR(corner.s, 3, 1e-12);
  }
}

// The top of a table alone, or its whole outline: sides behind its corners turn away from a ring above.
TEST(CommonRefinement, sidesThatNothingFacesChangeNoDirection) {
  for (const double half : {0.8, 1.05, 1.4}) {
    const SmoothPart part = smoothParts(lineThrough(circle(24, {0, 1.01}, 1), true)).front();
    const MortarLine top(lineThrough({{half, 0}, {-half, 0}}));
    const MortarLine table(lineThrough({{half, 0}, {-half, 0}, {-half, -2}, {half, -2}}, true));
    const CommonRefinement alone(part, top);
    const CommonRefinement whole(part, table);
    EXPECT_NEAR(alone.length(), whole.length(), rounding) << half;
    for (size_t i = 0; i < part.nodes.size(); ++i) {
      const auto node = static_cast<int>(i);
      EXPECT_EQ(alone.faces(node), whole.faces(node)) << half << ", " << i;
      EXPECT_LE((alone.directionAt(node) - whole.directionAt(node)).norm(), rounding) << half << ", " << i;
    }
  }
}

// Blocks with even sides have no corner that touches alone.
TEST(CommonRefinement, evenSidesTouchAllAlong) {
  const SmoothPart part = smoothParts(lineThrough(cut({{0, 0}, {1, 0}}, 8))).front();
  for (const double end : {0.0, 0.3}) {
    const MortarLine line(lineThrough(cut({{1 - end, 0}, {end, 0}}, 5)));
    const CommonRefinement refinement(part, line);
    EXPECT_TRUE(refinement.corners().empty());
    EXPECT_NEAR(refinement.length(), 1 - 2 * end, rounding);
  }
}

}  // namespace mortier::common_refinement_test
