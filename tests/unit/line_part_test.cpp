// Weights of parts of lines, and linear functions on both sides of them.
#include "mesh/line_part.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <numbers>
#include <utility>
#include <vector>

#include "base/error.h"

namespace mortier::line_part_test {

const BoundaryLine bent{{0, 1, 2}, {{0, 0}, {3, 0}, {3, 4}}};  // 7 long

/// 1 between 2 and 5, by the definition.
double weightAt(double s, double margin) {
  const double off = std::max({2 - s, s - 5, 0.0});
  return margin > 0 ? std::max(0.0, 1 - off / margin) : off > 0 ? 0 : 1;
}

TEST(LinePart, knowsPlacesAlongALine) {
  const LinePart part(bent, {3, 2}, {2, 0}, 0);
  EXPECT_DOUBLE_EQ(part.along({2, 0.5}), 2);
  EXPECT_DOUBLE_EQ(part.along({3, 2}), 5);
  EXPECT_DOUBLE_EQ(part.along({3, 9}), 7);
  EXPECT_NEAR(part.size(), 3, 1e-12);
  EXPECT_NEAR(LinePart(bent).size(), 7, 1e-12);
  // 2 pi r over 1 m from r = 2 to 3 and 2 m at r = 3.
  EXPECT_NEAR(part.size(true), 2 * std::numbers::pi * (2.5 + 6), 1e-11);
}

TEST(LinePart, weighsAndEnclosesItsWeight) {
  for (const double margin : {0.0, 0.5, 1.5, 4.0}) {
    const LinePart part(bent, {2, 0}, {3, 2}, margin);
    for (const auto& [first, last] : std::vector<std::pair<double, double>>{
             {0, 7}, {0, 1}, {1.2, 2.4}, {2.5, 2.2}, {2, 5}, {1.9, 5.1}, {4.5, 6.9}, {6.6, 7}, {3, 4}}) {
      constexpr int parts = 20000;
      const std::array<double, 2> moments = part.moments(first, last);
      const std::array<double, 2> above = part.above(first, last);
      const std::array<double, 2> below = part.below(first, last);
      std::array<double, 2> sums{};
      double closest = 2;
      double largest = 0;
      for (int i = 0; i < parts; ++i) {
        const double x = (i + 0.5) / parts;
        const double w = weightAt(first + x * (last - first), margin);
        sums[0] += (1 - x) * w / parts;
        sums[1] += x * w / parts;
        EXPECT_GE((1 - x) * above[0] + x * above[1], w - 1e-12) << margin << " " << first << " " << last;
        EXPECT_LE((1 - x) * below[0] + x * below[1], w + 1e-12) << margin << " " << first << " " << last;
        closest = std::min(closest, (1 - x) * above[0] + x * above[1] - w);
        largest = std::max(largest, w);
      }
      for (int end = 0; end < 2; ++end) EXPECT_NEAR(moments[end], sums[end], 1e-4);
      EXPECT_NEAR(closest, 0, 1e-3) << "it could be nearer: " << margin << " " << first << " " << last;
      EXPECT_LE(std::max(above[0], above[1]), largest + 1 / (margin + 0.3)) << "far above";
    }
  }
}

// Where kinks are less than a stretch apart from its ends linear functions are nearer than constants.
TEST(LinePart, isLinearWhereTheWeightIs) {
  const LinePart part(bent, {2, 0}, {3, 2}, 1);
  for (const auto& of : {part.above(1.2, 1.9), part.below(1.2, 1.9)}) {
    EXPECT_NEAR(of[0], 0.2, 1e-12);
    EXPECT_NEAR(of[1], 0.9, 1e-12);
  }
  const auto above = part.above(1.5, 2.1);
  EXPECT_NEAR(above[1] - above[0], 0.5, 1e-12);
}

TEST(LinePart, refusesWhatIsNoPart) {
  EXPECT_THROW(LinePart(bent, {2, 0}, {2, 0}, 0), InputError);
  EXPECT_THROW(LinePart(bent, {2, 0}, {5, 4}, 0), InputError);
  EXPECT_THROW(LinePart(bent, {2, -1}, {3, 4}, 0), InputError);
  BoundaryLine closed = bent;
  closed.closed = true;
  EXPECT_THROW(LinePart(closed, {2, 0}, {3, 2}, 0), InputError);
}

}  // namespace mortier::line_part_test
