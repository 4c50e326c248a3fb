// What lies between sides as meshed and the surfaces that they stand for: with it volumes are those of closed
// forms, but for a higher order in the size of the sides.
#include "time/curve_error.h"

#include <gtest/gtest.h>

#include <Eigen/Geometry>
#include <cmath>
#include <numbers>
#include <numeric>
#include <tuple>
#include <vector>

#include "material/elasticity.h"
#include "mesh/shape.h"
#include "mesh/simplices.h"

namespace mortier::curve_error_test {

constexpr double pi = std::numbers::pi;

struct Sizes {
  double meshed;
  double all;  ///< with what is behind the sides
};
Sizes sizesOf(const Body& body) {
  const double meshed = std::accumulate(body.weights().begin(), body.weights().end(), 0.0);
  return {meshed, meshed + volumeBehindSides(body).sum()};
}

Sizes ofRound(bool ball, int cells, int degree) {
  const RoundBody round{.ball = ball, .radius = 2, .height = 3, .keep = {1, -1, 0}, .cells = {cells, 2}};
  return sizesOf({"round", roundMesh(round), elasticMaterial({1, 0.3}, Plane::none), Conditions{}, degree});
}

TEST(CurveError, volumesAreThoseOfCylindersAndBalls) {
  for (const int degree : {1, 2}) {
    const double cylinder = 3 * pi;  // a quarter of it
    const double ball = 8 * pi / 3;  // a quarter of 4/3 pi 8
    for (const auto& [isBall, exact] : {std::pair(false, cylinder), std::pair(true, ball)}) {
      const Sizes coarse = ofRound(isBall, 2, degree);
      const Sizes fine = ofRound(isBall, 4, degree);
      EXPECT_GT(exact - coarse.meshed, 0.01 * exact);
      EXPECT_LT(std::abs(coarse.all - exact), 0.1 * (exact - coarse.meshed));
      EXPECT_LT(std::abs(fine.all - exact), 0.03 * (exact - fine.meshed));
    }
  }
}

TEST(CurveError, areasAreThoseOfRings) {
  const MeshShape ring{Annulus{{0, 0}, 1, 2, 1, 6, 2}};
  const double exact = 3 * pi / 4;
  const Sizes linear = sizesOf({"ring", shapeMesh(ring), elasticMaterial({1, 0.3}), Conditions{}});
  EXPECT_GT(exact - linear.meshed, 0.005 * exact);
  EXPECT_LT(std::abs(linear.all - exact), 0.02 * (exact - linear.meshed));
}

double areaOf(const TetrahedronMesh& mesh, int label) {
  double area = 0;
  for (const auto& [a, b, c] : sidesWith(mesh, label))
    area += (mesh.vertices[b] - mesh.vertices[a]).cross(mesh.vertices[c] - mesh.vertices[a]).norm() / 2;
  return area;
}

TEST(CurveError, sidesGrowToArcsSpheresAndDiscs) {
  const MeshShape shape{Annulus{{0, 0}, 1, 2, 1, 6, 2}};
  const Body ring("ring", shapeMesh(shape), elasticMaterial({1, 0.3}), Conditions{});
  const double chords = 6 * 4 * std::sin(pi / 24);  // of the outer quarter
  EXPECT_NEAR(growthOfSide(ring, 2, std::vector<char>(ring.nodes(), 1)), pi - chords, 0.02 * (pi - chords));
  EXPECT_EQ(growthOfSide(ring, 2, std::vector<char>(ring.nodes(), 0)), 0);
  // The curved side of a quarter of a ball, and the top of a quarter of a cylinder, which ends at a curve.
  for (const auto& [ball, label, exact] : {std::tuple(true, 7, 4 * pi), std::tuple(false, 3, pi)}) {
    const RoundBody round{.ball = ball, .radius = 2, .height = 3, .keep = {1, -1, 0}, .cells = {4, 2}};
    const Body body("round", roundMesh(round), elasticMaterial({1, 0.3}, Plane::none), Conditions{}, 1);
    const double missing = exact - areaOf(body.space()->mesh(), label);
    EXPECT_GT(missing, 0.005 * exact);
    EXPECT_NEAR(growthOfSide(body, label, std::vector<char>(body.nodes(), 1)), missing, 0.1 * missing);
  }
}

TEST(CurveError, flatSidesHaveNone) {
  const Body cube("cube", cuboidMesh({}), elasticMaterial({1, 0.3}, Plane::none), Conditions{}, 1);
  EXPECT_EQ(volumeBehindSides(cube).cwiseAbs().maxCoeff(), 0);
}

}  // namespace mortier::curve_error_test
