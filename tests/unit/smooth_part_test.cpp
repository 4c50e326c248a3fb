#include "contact/smooth_part.h"

#include <gtest/gtest.h>

#include <cmath>

namespace mortier::smooth_part_test {

TEST(SmoothPart, oneBentElementBetweenCornersHasTheNormalsOfItsParabola) {
  for (const double bow : {-0.1, 0.2}) {
    BoundaryLine line;
    line.nodes = {3, 5};
    line.points = {{0, 0}, {1, 0}};
    line.middleNodes = {7};
    line.middlePoints = {{0.5, bow}};
    const std::vector<SmoothPart> parts = smoothParts(line);
    ASSERT_EQ(parts.size(), 1U);
    EXPECT_FALSE(parts[0].straight);
    ASSERT_EQ(parts[0].normals.size(), 2U);
    // y = 4 bow x (1 - x), the body above.
    EXPECT_LE((parts[0].normals[0] - Point(4 * bow, -1).normalized()).norm(), 1e-15);
    EXPECT_LE((parts[0].normals[1] - Point(-4 * bow, -1).normalized()).norm(), 1e-15);
  }
}

// A curve that a mesh resolves turns about as much at every node; sides that are known to be straight have
// corners between them, however little the line turns, and none where one of them is cut.
TEST(SmoothPart, sidesThatAreKnownToBeStraightMeetAtCorners) {
  const double turn = M_PI / 720;
  BoundaryLine line;
  line.points = {{0, 0}};
  for (int side = 0; side < 4; ++side)
    for (int cut = 0; cut < 3; ++cut)
      line.points.emplace_back(line.points.back() + Point(std::cos(side * turn), std::sin(side * turn)));
  for (size_t i = 0; i < line.points.size(); ++i) line.nodes.push_back(static_cast<int>(i));
  EXPECT_EQ(smoothParts(line, Kinks::ofStraightElements).size(), 1U);
  for (size_t i = 1; i < line.points.size(); ++i)
    line.middles.emplace_back((line.points[i - 1] + line.points[i]) / 2);
  EXPECT_EQ(smoothParts(line).size(), 1U);
  const std::vector<SmoothPart> parts = smoothParts(line, Kinks::ofStraightElements);
  ASSERT_EQ(parts.size(), 4U);
  for (const SmoothPart& part : parts) {
    EXPECT_EQ(part.elements(), 3);
    EXPECT_TRUE(part.straight);
  }
}

}  // namespace mortier::smooth_part_test
