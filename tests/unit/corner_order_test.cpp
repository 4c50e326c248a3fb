// Orders of unbounded stresses at corners: published roots of Williams' equations (1952).
#include "time/corner_order.h"

#include <gtest/gtest.h>

#include <numbers>

namespace mortier {
namespace {

constexpr double kappaInStrain = 1.8;                    // kappa at nu = 0.3 in plane strain
constexpr double kappaInStress = (3 - 0.3) / (1 + 0.3);  // in plane stress
constexpr double toDigits = 1e-6;

TEST(CornerOrder, isThatOfWilliams) {
  using enum SideSupport;
  EXPECT_NEAR(orderOfCorner(2 * std::numbers::pi, free, free, kappaInStrain), 0.5, toDigits);  // a crack
  EXPECT_NEAR(orderOfCorner(1.5 * std::numbers::pi, free, free, kappaInStrain), 1 - 0.5444837, toDigits);
  EXPECT_NEAR(orderOfCorner(1.5 * std::numbers::pi, held, held, kappaInStrain), 1 - 0.5951564, toDigits);
  EXPECT_NEAR(orderOfCorner(std::numbers::pi / 2, held, free, kappaInStress), 1 - 0.7583492, toDigits);
  EXPECT_NEAR(orderOfCorner(std::numbers::pi / 2, free, held, kappaInStrain), 1 - 0.7111729, toDigits);
}

TEST(CornerOrder, aPlaneOfSymmetryHalvesTheCorner) {
  using enum SideSupport;
  EXPECT_NEAR(orderOfCorner(0.75 * std::numbers::pi, sliding, free, kappaInStrain), 1 - 0.5444837, toDigits);
  EXPECT_NEAR(orderOfCorner(1.5 * std::numbers::pi, sliding, sliding, kappaInStrain), 2.0 / 3, toDigits);
}

TEST(CornerOrder, convexAndSmoothCornersHaveNone) {
  using enum SideSupport;
  EXPECT_EQ(orderOfCorner(std::numbers::pi / 2, free, free, kappaInStrain), 0);
  EXPECT_EQ(orderOfCorner(1.02 * std::numbers::pi, free, free, kappaInStrain), 0);
  EXPECT_EQ(orderOfCorner(std::numbers::pi / 2, sliding, free, kappaInStrain), 0);
  EXPECT_EQ(orderOfCorner(std::numbers::pi / 2, sliding, sliding, kappaInStrain), 0);
  EXPECT_EQ(orderOfCorner(std::numbers::pi / 2, held, held, kappaInStrain), 0);
}

}  // namespace
}  // namespace mortier
