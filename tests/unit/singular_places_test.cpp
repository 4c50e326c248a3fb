// Corners where stresses are unbounded: published roots of Williams' equations (1952), stresses like r^(l-1).
#include "time/singular_places.h"

#include <gtest/gtest.h>

#include <numbers>

namespace mortier {
namespace {

constexpr double kappa = 1.8;  // nu = 0.3 in plane strain
constexpr double rightAngle = std::numbers::pi / 2;

TEST(SingularCorners, areThoseOfWilliams) {
  using enum SideSupport;
  EXPECT_TRUE(isSingular(4 * rightAngle, free, free, kappa));              // a crack: l = 0.5
  EXPECT_TRUE(isSingular(3 * rightAngle, free, free, kappa));              // 0.544
  EXPECT_TRUE(isSingular(3 * rightAngle, held, held, kappa));              // 0.595 at nu = 0.3
  EXPECT_TRUE(isSingular(rightAngle, held, free, (3 - 0.3) / (1 + 0.3)));  // 0.758 in plane stress
  EXPECT_TRUE(isSingular(rightAngle, free, held, kappa));                  // 0.711 in plane strain
}

TEST(SingularCorners, aPlaneOfSymmetryHalvesTheCorner) {
  using enum SideSupport;
  EXPECT_TRUE(isSingular(1.5 * rightAngle, sliding, free, kappa));     // 0.544
  EXPECT_TRUE(isSingular(1.5 * rightAngle, held, sliding, kappa));     // 0.595
  EXPECT_TRUE(isSingular(3 * rightAngle, sliding, sliding, kappa));    // 1/3
  EXPECT_TRUE(isSingular(1.2 * rightAngle, sliding, sliding, kappa));  // 2/3
}

TEST(SingularCorners, areNeitherConvexNorSmooth) {
  using enum SideSupport;
  EXPECT_FALSE(isSingular(rightAngle, free, free, kappa));
  EXPECT_FALSE(isSingular(2.04 * rightAngle, free, free, kappa));
  EXPECT_FALSE(isSingular(rightAngle, sliding, free, kappa));
  EXPECT_FALSE(isSingular(rightAngle, sliding, sliding, kappa));
  EXPECT_FALSE(isSingular(2 * rightAngle, sliding, sliding, kappa));
  EXPECT_FALSE(isSingular(2.04 * rightAngle, sliding, sliding, kappa));
  EXPECT_FALSE(isSingular(rightAngle, held, held, kappa));
  EXPECT_FALSE(isSingular(0.6 * rightAngle, held, free, kappa));
  EXPECT_FALSE(isSingular(rightAngle, held, free, 3));  // without contraction
}

}  // namespace
}  // namespace mortier
