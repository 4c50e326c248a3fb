#include <gtest/gtest.h>

#include <random>

#include "unit/random_trace.h"
#include "unit/straight_lines.h"

namespace mortier::segments_test {

TEST(Segments, coverTheOverlapOnce) {
  constexpr double rounding = 1e-14;
  std::mt19937 random(5);
  std::uniform_int_distribution<int> elements(1, 40);
  for (int trial = 0; trial < 200; ++trial) {
    const Trace nonmortar = randomTrace(random, elements(random), 0, 1, 50);
    const bool same = trial % 2 == 0;
    const Trace mortar = randomTrace(random, elements(random), same ? 0 : 0.21, same ? 1 : 1.4, 50);
    const StraightLines lines(nonmortar, mortar);
    ASSERT_FALSE(lines.refinement.empty());
    double end = same ? 0 : 0.21;
    for (const Segment& segment : lines.refinement.segments()) {
      ASSERT_NEAR(segment.begin, end, rounding);
      ASSERT_LT(segment.begin, segment.end);
      ASSERT_TRUE(nonmortar[segment.nonmortar] <= segment.begin &&
                  segment.end <= nonmortar[segment.nonmortar + 1]);
      ASSERT_TRUE(mortar[segment.mortar] <= segment.begin + rounding &&
                  segment.end <= mortar[segment.mortar + 1] + rounding);
      end = segment.end;
    }
    ASSERT_NEAR(end, 1, rounding);
    ASSERT_NEAR(lines.refinement.length(), same ? 1 : 0.79, rounding);
    Trace faced = lines.refinement.mortarNodes();
    size_t first = 0;
    while (first + 1 < mortar.size() && mortar[first + 1] <= rounding) ++first;
    for (const double s : faced) ASSERT_NEAR(s, mortar[first++], 10 * rounding);
  }
  EXPECT_TRUE(StraightLines({0, 1}, {1.1, 2}).refinement.segments().empty());
  EXPECT_TRUE(StraightLines({0, 1}, {5, 6}).refinement.segments().empty());
}

}  // namespace mortier::segments_test
