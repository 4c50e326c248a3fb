// Overlaps of bodies by their boundaries, against closed forms.
#include "contact/overlap.h"

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>
#include <numeric>

#include "mesh/shape.h"

namespace mortier::overlap_test {

constexpr double rounding = 1e-14;

MovedOutline outlined(const TriangleMesh& mesh, int degree = 1) {
  const ElementNodes nodes = elementNodes(mesh, degree);
  return {outlineOf(mesh, nodes), nodes.places};
}

TriangleMesh square(const Point& lower, double size, int cells = 1) {
  return rectangleMesh({lower, lower + Point(size, size), cells, cells});
}

TriangleMesh disc(const Point& centre, double radius) {
  return outlineMesh(discOutline(centre, radius, false));
}

double areaOf(const std::vector<CommonRegion>& overlaps) {
  return std::accumulate(overlaps.begin(), overlaps.end(), 0.0,
                         [](double sum, const CommonRegion& each) { return sum + each.area; });
}

TEST(Overlap, ofTwoSquaresIsTheStripThatBothHave) {
  for (const double by : {1e-3, 1e-9, 0.3}) {
    const std::vector<CommonRegion> found =
        commonRegions(outlined(square({0, 0}, 1, 3)), outlined(square({0.2, 1 - by}, 0.6, 2)), rounding);
    ASSERT_EQ(found.size(), 1u) << by;
    EXPECT_NEAR(found[0].area, 0.6 * by, 1e-14);
    EXPECT_NEAR(found[0].depth, by, 1e-14);
  }
}

// A corner that all four sides of the other body are farther from than its own two.
TEST(Overlap, ofACornerInACornerIsASquareAndItsDepthTheShorterWayOut) {
  const std::vector<CommonRegion> found =
      commonRegions(outlined(square({0, 0}, 1)), outlined(square({0.9, 0.8}, 1, 2)), rounding);
  ASSERT_EQ(found.size(), 1u);
  EXPECT_NEAR(found[0].area, 0.1 * 0.2, 1e-15);
  EXPECT_NEAR(found[0].depth, 0.1, 1e-15);
}

TEST(Overlap, ofADiscOnAHalfPlaneIsASegment) {
  const double by = 0.01;
  const std::vector<CommonRegion> found =
      commonRegions(outlined(disc({0, 1 - by}, 1)), outlined(square({-4, -8}, 8, 1)), rounding);
  ASSERT_EQ(found.size(), 1u);
  const double half = std::acos(1 - by);
  EXPECT_NEAR(found[0].area, half - std::sin(half) * std::cos(half), 2e-3 * half * by);
  EXPECT_NEAR(found[0].depth, by, 1e-12);
  EXPECT_NEAR(found[0].place.x(), 0, 1e-12);
  EXPECT_NEAR(found[0].place.y(), -by, 1e-12);
}

TEST(Overlap, ofABodyWithinAnotherIsThatBody) {
  const std::vector<CommonRegion> found =
      commonRegions(outlined(square({0, 0}, 1, 4)), outlined(square({0.3, 0.4}, 0.2, 2)), rounding);
  ASSERT_EQ(found.size(), 1u);
  EXPECT_NEAR(found[0].area, 0.04, 1e-15);
  EXPECT_NEAR(found[0].depth, 0.5, 1e-15);  // the far side of the inner square is 0.5 from the nearest
}

TEST(Overlap, ofBarsThatCrossHasNoCornerInside) {
  const std::vector<CommonRegion> found =
      commonRegions(outlined(rectangleMesh({{-2, -0.1}, {2, 0.1}, 1, 1})),
                    outlined(rectangleMesh({{-0.3, -3}, {0.3, 3}, 1, 1})), rounding);
  ASSERT_EQ(found.size(), 1u);
  EXPECT_NEAR(found[0].area, 0.2 * 0.6, 1e-14);
  EXPECT_NEAR(found[0].depth, 0.3, 1e-14);
}

TEST(Overlap, ofAToothedSideAreRegionsOfTheirOwn) {
  Outline teeth;
  teeth.points = {{0, 1}, {0, 0}, {1, 0.5}, {2, -0.1}, {3, 0.5}, {4, 0}, {4, 1}};
  teeth.labels.assign(7, 1);
  const std::vector<CommonRegion> found = commonRegions(
      outlined(outlineMesh(teeth)), outlined(rectangleMesh({{-1, -1}, {5, 0.2}, 7, 2})), rounding);
  ASSERT_EQ(found.size(), 3u);
  EXPECT_NEAR(areaOf(found), 2 * 0.5 * 0.4 * 0.2 + 0.5 * 0.3 * 1.0, 1e-14);
}

TEST(Overlap, isNoneWhereBodiesTouch) {
  const TriangleMesh below = rectangleMesh({{0, -1}, {1, 0}, 7, 3});
  for (const int cells : {7, 5, 1}) {
    TriangleMesh above = rectangleMesh({{0, 0}, {1, 1}, cells, 2});
    EXPECT_TRUE(commonRegions(outlined(below), outlined(above), rounding).empty()) << cells;
    for (size_t v = 0; v < above.vertices.size(); ++v) above.vertices[v].y() += v % 2 == 0 ? 1e-16 : -1e-16;
    EXPECT_TRUE(commonRegions(outlined(below), outlined(above), rounding).empty()) << cells;
  }
  // A ring about a disc with the same nodes, in another order and with rounding.
  const TriangleMesh ring = shapeMesh({Annulus{{0.1, 0.2}, 1, 2, 4, 48, 2}});
  TriangleMesh inner = shapeMesh({Annulus{{0.1, 0.2}, 0.5, 1, 4, 48, 2}});
  for (Point& x : inner.vertices) x = x * (1 + 1e-16) + Point(1e-16, -1e-16);
  for (const int degree : {1, 2})
    EXPECT_TRUE(commonRegions(outlined(ring, degree), outlined(inner, degree), 4 * rounding).empty())
        << degree;
}

TEST(Overlap, ofBodiesThatShareASideCountsItOnce) {
  const std::vector<CommonRegion> found =
      commonRegions(outlined(square({0, 0}, 1, 4)), outlined(square({0.25, 0}, 0.5, 3)), rounding);
  EXPECT_NEAR(areaOf(found), 0.25, 1e-14);
}

// A side whose middle is moved out of it by d: the parabola, to the error of eight chords.
TEST(Overlap, ofABentSideIsThatOfItsParabola) {
  const TriangleMesh mesh = square({0, 0}, 1);
  ElementNodes nodes = elementNodes(mesh, 2);
  const double by = 0.01;
  for (Point& x : nodes.places)
    if (x == Point(0.5, 1)) x.y() += by;
  const MovedOutline bent(outlineOf(mesh, nodes), nodes.places);
  const std::vector<CommonRegion> found =
      commonRegions(bent, outlined(rectangleMesh({{-1, 1}, {2, 2}, 1, 1})), rounding);
  EXPECT_NEAR(areaOf(found), 2.0 / 3 * by, 2.0 / 3 * by / 50);
  ASSERT_FALSE(found.empty());
  EXPECT_NEAR(found[0].depth, by, 1e-14);
}

// Lengths and places scale; nothing is compared with an absolute length.
TEST(Overlap, scales) {
  for (const double scale : {1e-9, 1e9}) {
    const std::vector<CommonRegion> found =
        commonRegions(outlined(square({0, 0}, scale, 3)),
                      outlined(square({0.2 * scale, 0.999 * scale}, scale)), scale * rounding);
    ASSERT_EQ(found.size(), 1u);
    EXPECT_NEAR(found[0].area, 8e-4 * scale * scale, 1e-12 * scale * scale);
    EXPECT_NEAR(found[0].depth, 1e-3 * scale, 1e-12 * scale);
  }
}

TEST(Overlap, ofALineToolIsBehindItsLine) {
  const TriangleMesh tool = outlineMesh(lineOutline({5, 0}, {-5, 0}));
  const std::vector<CommonRegion> found =
      commonRegions(outlined(tool), outlined(square({-1, -0.01}, 2, 3)), rounding);
  ASSERT_EQ(found.size(), 1u);
  EXPECT_NEAR(found[0].depth, 0.01, 1e-14);
  const BodyOutline outline = outlineOf(tool, elementNodes(tool, 1));
  for (const PointInside& point : found[0].points) {
    EXPECT_TRUE(point.of == 0 || outline.sides[point.across].label == 1);
  }
}

}  // namespace mortier::overlap_test
