// Orders of unbounded stresses at corners: published roots of Williams' equations (1952).
#include "time/corner_order.h"

#include <gtest/gtest.h>

#include <numbers>

namespace mortier {
namespace {

constexpr double pi = std::numbers::pi;
constexpr double strain = 1.8;                    // kappa at nu = 0.3 in plane strain
constexpr double stress = (3 - 0.3) / (1 + 0.3);  // in plane stress
constexpr double exact = 1e-6;

TEST(CornerOrder, isThatOfWilliams) {
  using enum SideSupport;
  EXPECT_NEAR(orderOfCorner(2 * pi, free, free, strain), 0.5, exact);  // a crack
  EXPECT_NEAR(orderOfCorner(1.5 * pi, free, free, strain), 1 - 0.5444837, exact);
  EXPECT_NEAR(orderOfCorner(1.5 * pi, held, held, strain), 1 - 0.5951564, exact);
  EXPECT_NEAR(orderOfCorner(pi / 2, held, free, stress), 1 - 0.7583492, exact);
  EXPECT_NEAR(orderOfCorner(pi / 2, free, held, strain), 1 - 0.7111729, exact);
}

TEST(CornerOrder, aPlaneOfSymmetryHalvesTheCorner) {
  using enum SideSupport;
  EXPECT_NEAR(orderOfCorner(0.75 * pi, sliding, free, strain), 1 - 0.5444837, exact);
  EXPECT_NEAR(orderOfCorner(1.5 * pi, sliding, sliding, strain), 2.0 / 3, exact);
}

TEST(CornerOrder, convexAndSmoothCornersHaveNone) {
  using enum SideSupport;
  EXPECT_EQ(orderOfCorner(pi / 2, free, free, strain), 0);
  EXPECT_EQ(orderOfCorner(1.02 * pi, free, free, strain), 0);
  EXPECT_EQ(orderOfCorner(pi / 2, sliding, free, strain), 0);
  EXPECT_EQ(orderOfCorner(pi / 2, sliding, sliding, strain), 0);
  EXPECT_EQ(orderOfCorner(pi / 2, held, held, strain), 0);
}

}  // namespace
}  // namespace mortier
