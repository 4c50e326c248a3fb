// Meshes of rigid bodies, which are made from their outlines.
#include "mesh/shape.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "base/error.h"

namespace mortier::outline_test {

double areaOf(const TriangleMesh& mesh) {
  double area = 0;
  for (int t = 0; t < static_cast<int>(mesh.triangles.size()); ++t) area += doubleArea(mesh, t) / 2;
  return area;
}

TEST(Outline, trianglesFillIt) {
  const Outline notched{{{0, 0}, {4, 0}, {4, 3}, {2, 1}, {0, 3}}, {1, 2, 3, 4, 5}};
  const TriangleMesh mesh = outlineMesh(notched);
  EXPECT_EQ(mesh.triangles.size(), 3U);
  EXPECT_NEAR(areaOf(mesh), 8, 1e-14);
  EXPECT_EQ(mesh.boundaryLabels, notched.labels);
}

TEST(Outline, sidesInLineAreKept) {
  const TriangleMesh mesh =
      outlineMesh({{{0, 0}, {1, 0}, {2, 0}, {2, 1}, {1, 1}, {0, 1}}, {1, 1, 2, 3, 3, 4}});
  EXPECT_EQ(mesh.triangles.size(), 4U);
  EXPECT_NEAR(areaOf(mesh), 2, 1e-14);
}

TEST(Outline, discsAreRound) {
  const TriangleMesh disc = outlineMesh(discOutline({3, -1}, 2, false));
  EXPECT_NEAR(areaOf(disc), 4 * M_PI, 1e-3);
  for (const Point& x : disc.vertices) EXPECT_NEAR((x - Point(3, -1)).norm(), 2, 1e-15);
  const TriangleMesh half = outlineMesh(discOutline({0, 2}, 2, true));
  EXPECT_NEAR(areaOf(half), 2 * M_PI, 1e-3);
  EXPECT_EQ(std::count(half.boundaryLabels.begin(), half.boundaryLabels.end(), 2), 1);
  for (const Point& x : half.vertices) EXPECT_GE(x.x(), 0);
}

TEST(Outline, splinesGoThroughTheirPoints) {
  std::vector<Point> points;
  for (int i = 0; i <= 12; ++i)
    points.emplace_back(std::cos(2 * M_PI * (i % 12) / 12), std::sin(2 * M_PI * (i % 12) / 12));
  const Outline round = splineOutline(points);
  for (int i = 0; i < 12; ++i) EXPECT_EQ(round.points[32 * i], points[i]);
  for (const EdgeCurve& curve : round.curves)
    for (const double t : {curve.from, (curve.from + curve.to) / 2, curve.to})
      EXPECT_NEAR(curve.at(t).norm(), 1, 3e-4);  // of a cubic through twelve points: h^4/384
  const Outline open = splineOutline({{0, 1}, {1, 0}, {2, 1}});
  EXPECT_EQ(open.points.back(), Point(2, 1));
  EXPECT_EQ(open.labels.back(), 2);
  EXPECT_FALSE(open.curves.back().known());
  EXPECT_NEAR(areaOf(outlineMesh(open)), 1.25, 1e-3);  // y = 1 - 1.5 s + 0.5 s^3 by chords, twice 0.625
}

TEST(Outline, wrongOnesAreNamed) {
  for (const Outline& wrong : {Outline{{{0, 0}, {0, 1}, {1, 1}}, {1, 1, 1}},             // clockwise
                               Outline{{{0, 0}, {1, 1}, {1, 0}, {0, 1}}, {1, 1, 1, 1}},  // crosses
                               Outline{{{0, 0}, {1, 0}, {2, 0}}, {1, 1, 1}}})            // flat
    EXPECT_THROW(static_cast<void>(outlineMesh(wrong)), InputError);
}

}  // namespace mortier::outline_test
