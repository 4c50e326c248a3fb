#include "base/worst.h"

#include <gtest/gtest.h>

#include <limits>

namespace mortier::worst_test {

constexpr double nan = std::numeric_limits<double>::quiet_NaN();

TEST(Worst, isTheLargest) {
  Worst worst;
  EXPECT_EQ(worst.value(), 0);
  worst.add(Vector());
  EXPECT_EQ(worst.value(), 0);
  worst.add(Vector::LinSpaced(5, -3, 1));
  worst.add(2);
  EXPECT_EQ(worst.value(), 3);
  EXPECT_EQ(worse(1, 2), 2);
  EXPECT_EQ(worse(2, 1), 2);
}

TEST(Worst, aNaNStaysWhateverComesAfterIt) {
  for (int at = 0; at < 9; ++at) {
    Vector entries = Vector::Constant(9, -1);
    entries[at] = nan;
    Worst all;
    all.add(entries);
    all.add(5);
    EXPECT_TRUE(std::isnan(all.value())) << at;
    Worst each;
    for (const double entry : entries) each.add(entry);
    EXPECT_TRUE(std::isnan(each.value())) << at;
  }
  EXPECT_TRUE(std::isnan(worse(nan, 1)));
  EXPECT_TRUE(std::isnan(worse(1, nan)));
}

}  // namespace mortier::worst_test
