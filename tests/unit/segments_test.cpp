#include "contact/smooth_part.h"

#include <gtest/gtest.h>

#include <random>

#include "unit/random_trace.h"

namespace mortier::segments_test {

TEST(Segments, coverTheOverlapOnce) {
  std::mt19937 random(5);
  std::uniform_int_distribution<int> elements(1, 40);
  for (int trial = 0; trial < 200; ++trial) {
    const Trace nonmortar = randomTrace(random, elements(random), 0, 1, 50);
    const bool same = trial % 2 == 0;
    const Trace mortar = randomTrace(random, elements(random), same ? 0 : 0.21, same ? 1 : 1.4, 50);
    const std::vector<Segment> segments = commonRefinement(nonmortar, mortar);
    ASSERT_FALSE(segments.empty());
    double end = same ? 0 : 0.21;
    for (const Segment& segment : segments) {
      ASSERT_EQ(segment.begin, end);
      ASSERT_LT(segment.begin, segment.end);
      ASSERT_TRUE(nonmortar[segment.nonmortar] <= segment.begin &&
                  segment.end <= nonmortar[segment.nonmortar + 1]);
      ASSERT_TRUE(mortar[segment.mortar] <= segment.begin && segment.end <= mortar[segment.mortar + 1]);
      end = segment.end;
    }
    ASSERT_EQ(end, 1);
  }
  EXPECT_TRUE(commonRefinement({0, 1}, {1, 2}).empty());
  EXPECT_TRUE(commonRefinement({0, 1}, {5, 6}).empty());
}

}  // namespace mortier::segments_test
