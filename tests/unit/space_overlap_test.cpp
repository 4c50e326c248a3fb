// Points of surfaces within other bodies, against closed forms.
#include "contact/space_overlap.h"

#include <gtest/gtest.h>

#include <algorithm>

#include "mesh/shape.h"

namespace mortier::space_overlap_test {

constexpr double rounding = 1e-14;

struct Outlined {
  SpaceOutline outline;
  MovedSurface surface;

  Outlined(const TetrahedronMesh& mesh, int degree, const SpacePoint& by = {0, 0, 0})
      : outline(outlineOf(mesh, spaceNodes(mesh, degree))), surface(outline, moved(mesh, degree, by)) {}
  static std::vector<SpacePoint> moved(const TetrahedronMesh& mesh, int degree, const SpacePoint& by) {
    std::vector<SpacePoint> places = spaceNodes(mesh, degree).places;
    for (SpacePoint& x : places) x += by;
    return places;
  }
};

double depthOf(const std::vector<SpacePointInside>& points) {
  double most = 0;
  for (const SpacePointInside& point : points) most = std::max(most, point.depth);
  return most;
}

const TetrahedronMesh cube = cuboidMesh({{0, 0, 0}, {1, 1, 1}, {3, 3, 3}});

TEST(SpaceOverlap, ofTwoCubesIsAsDeepAsTheyOverlap) {
  for (const int degree : {1, 2})
    for (const double by : {1e-9, 1e-3, 0.1}) {
      const Outlined below(cube, degree);
      const Outlined above(cuboidMesh({{0.2, 0.2, 1 - by}, {0.8, 0.8, 2}, {2, 2, 2}}), degree);
      EXPECT_NEAR(depthOf(pointsInside(below.surface, above.surface, rounding)), by, 1e-14);
      EXPECT_NEAR(depthOf(pointsInside(above.surface, below.surface, rounding)), by, 1e-14);
    }
}

TEST(SpaceOverlap, isNoneWhereBodiesTouch) {
  for (const int degree : {1, 2})
    for (const int cells : {2, 3}) {
      const Outlined below(cube, degree);
      const Outlined above(cuboidMesh({{0, 0, 1}, {1, 1, 2}, {cells, cells, 2}}), degree, {1e-16, 0, -1e-16});
      EXPECT_TRUE(pointsInside(below.surface, above.surface, rounding).empty()) << degree << cells;
    }
}

// The lowest vertex of a ball below a plane.
TEST(SpaceOverlap, ofABallOnAPlaneIsThatOfItsLowestVertex) {
  const RoundBody round{true, {0, 0, 1}, 1, 1, {0, 0, 0}, {6, 1}};
  const Outlined ball(roundMesh(round), 1, {0, 0, -0.02});
  const Outlined block(cuboidMesh({{-2, -2, -1}, {2, 2, 0}, {5, 5, 2}}), 1);
  const std::vector<SpacePointInside> points = pointsInside(ball.surface, block.surface, rounding);
  ASSERT_FALSE(points.empty());
  EXPECT_NEAR(depthOf(points), 0.02, 1e-12);
  for (const SpacePointInside& point : points) EXPECT_EQ(block.outline.labels[point.across], 3);
}

// A quarter of it: the lowest vertex is on an edge of both bodies, in two planes of symmetry. Of the
// triangles there, those that face each other count.
TEST(SpaceOverlap, ofAQuarterOfABallIsThatOfTheBall) {
  const RoundBody round{true, {0, 0, 1}, 1, 1, {1, 1, -1}, {6, 1}};
  const Outlined ball(roundMesh(round), 1, {0, 0, -0.001});
  const Outlined block(cuboidMesh({{0, 0, -1}, {1, 1, 0}, {5, 5, 2}}), 1);
  const std::vector<SpacePointInside> points = pointsInside(ball.surface, block.surface, rounding);
  EXPECT_NEAR(depthOf(points), 0.001, 1e-12);
  for (const SpacePointInside& point : points) {
    const bool ofBall = point.of == 0;
    EXPECT_LE(ball.surface.normal(ofBall ? point.triangle : point.across).z(), -0.9);
    EXPECT_EQ(block.surface.normal(ofBall ? point.across : point.triangle), SpacePoint(0, 0, 1));
  }
}

// Distances have their sign on all sides of edges and vertices, reentrant ones too.
TEST(SpaceOverlap, knowsInsideFromOutside) {
  const Outlined body(cuboidMesh({{0, 0, 0}, {1, 2, 3}, {2, 2, 2}}), 1);
  for (const double x : {-0.3, 0.01, 0.5, 0.98, 1.2})
    for (const double y : {-0.4, 0.3, 1.0, 1.99, 2.5})
      for (const double z : {-1.0, 0.02, 1.5, 2.97, 3.1}) {
        const SpacePoint at(x, y, z);
        const Eigen::Array3d out = (-at.array()).max(at.array() - Eigen::Array3d(1, 2, 3));
        const double expected = out.maxCoeff() > 0 ? out.max(0).matrix().norm() : out.maxCoeff();
        EXPECT_NEAR(body.surface.nearest(at).distance, expected, 1e-12) << at.transpose();
      }
}

}  // namespace mortier::space_overlap_test
