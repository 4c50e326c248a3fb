#include "contact/smooth_part.h"

#include <gtest/gtest.h>

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

}  // namespace mortier::smooth_part_test
