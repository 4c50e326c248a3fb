// Lanes are eight numbers: every operation gives in each lane what it gives of one number.
#include "base/lanes.h"

#include <gtest/gtest.h>

#include <bit>
#include <cstdint>
#include <limits>

namespace mortier::lanes_test {
namespace {

using Eight = std::array<double, laneCount>;

constexpr double nan = std::numeric_limits<double>::quiet_NaN();
constexpr double infinite = std::numeric_limits<double>::infinity();
constexpr Eight left{1.5, -2, 0.0, -0.0, 1e300, nan, infinite, 3e-310};
constexpr Eight right{-4, -2, -0.0, 0.0, 1e300, 1, -infinite, 7};

Lanes lanes(const Eight& numbers) {
  return Batch(0, laneCount).load<1>(numbers.data())[0];
}

/// To the bit, but for the sign and the payload of NaN.
void expectSame(const Lanes& found, const Eight& expected) {
  for (int lane = 0; lane < laneCount; ++lane)
    if (std::isnan(expected[lane]))
      EXPECT_TRUE(std::isnan(found[lane])) << "lane " << lane;
    else
      EXPECT_EQ(std::bit_cast<std::uint64_t>(found[lane]), std::bit_cast<std::uint64_t>(expected[lane]))
          << "lane " << lane;
}

template <class Operation>
void expectByLane(const Operation& operation) {
  Eight expected;
  for (int lane = 0; lane < laneCount; ++lane) expected[lane] = operation(left[lane], right[lane]);
  expectSame(operation(lanes(left), lanes(right)), expected);
}

TEST(Lanes, computeAsNumbersDo) {
  expectByLane([](auto a, auto b) { return a + b; });
  expectByLane([](auto a, auto b) { return a - b; });
  expectByLane([](auto a, auto b) { return a * b; });
  expectByLane([](auto a, auto b) { return a / b; });
  expectByLane([](auto a, auto b) { return -a + 2 * b - 1; });
  using std::abs, std::exp, std::log, std::max, std::min, std::sqrt;
  expectByLane([](auto a, auto b) { return max(a, b); });
  expectByLane([](auto a, auto b) { return min(a, b); });
  expectByLane([](auto a, auto /*b*/) { return sqrt(a); });
  expectByLane([](auto a, auto /*b*/) { return abs(a); });
  expectByLane([](auto a, auto /*b*/) { return exp(a); });
  expectByLane([](auto a, auto /*b*/) { return log(a); });
  expectSame(Lanes(-0.0), {-0.0, -0.0, -0.0, -0.0, -0.0, -0.0, -0.0, -0.0});
}

TEST(Lanes, selectByLane) {
  const Lanes a = lanes(left);
  const Lanes b = lanes(right);
  Eight less;
  Eight atLeast;
  for (int lane = 0; lane < laneCount; ++lane) {
    less[lane] = left[lane] < right[lane] ? left[lane] : 5;
    atLeast[lane] = left[lane] >= right[lane] && left[lane] > 0 ? left[lane] : 5;
  }
  expectSame(select(a < b, a, 5), less);
  expectSame(select(a >= b && a > 0, a, 5), atLeast);
  for (int lane = 0; lane < laneCount; ++lane) {
    Eight one{};
    one[lane] = 1;
    EXPECT_TRUE(any_of(lanes(one) > 0)) << "lane " << lane;
    EXPECT_FALSE(none_of(lanes(one) > 0)) << "lane " << lane;
  }
  EXPECT_TRUE(none_of(LaneMask(false)));
  EXPECT_TRUE(none_of(!LaneMask(true)));
}

}  // namespace
}  // namespace mortier::lanes_test
