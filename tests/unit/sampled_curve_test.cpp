// Curves by points of them, and meshes whose edges stand for them.
#include "mesh/triangle_mesh.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <random>

#include "mesh/boundary_line.h"
#include "mesh/generate.h"
#include "mesh/refine.h"
#include "mesh/regions.h"

namespace mortier::sampled_curve_test {

template <class Curve>
SampledCurve sampledFrom(const Curve& at, double tolerance) {
  const auto points = [&](const std::vector<double>& t) {
    std::vector<Point> x;
    for (const double each : t) x.push_back(at(each));
    return x;
  };
  return sampled(points, tolerance);
}

template <class Curve>
double largestError(const SampledCurve& curve, const Curve& at) {
  double largest = 0;
  for (int i = 0; i <= 10007; ++i)
    largest = std::max(largest, (curve.at(i / 10007.0) - at(i / 10007.0)).norm());
  return largest;
}

TEST(SampledCurve, smoothCurvesTakeFewPieces) {
  for (const double size : {1e-9, 1.0, 1e9}) {
    const auto ellipse = [&](double t) {
      return Point(size * (5 + 2 * std::cos(6 * t)), size * std::sin(6 * t));
    };
    const SampledCurve curve = sampledFrom(ellipse, 1e-11 * size);
    EXPECT_LE(curve.knots.size(), 17U);
    EXPECT_EQ(curve.points.size(), 8 * (curve.knots.size() - 1) + 1);
    EXPECT_LE(largestError(curve, ellipse), 2e-11 * size);
    EXPECT_EQ(curve.at(0), ellipse(0));
    EXPECT_EQ(curve.at(1), ellipse(1));
  }
}

// A jump of the curvature, of the direction: the pieces around it are small.
TEST(SampledCurve, knotsAndKinksAreFound) {
  for (const int power : {1, 2, 3}) {
    const auto bent = [&](double t) { return Point(t, std::pow(std::max(0.0, t - 0.3141), power)); };
    const SampledCurve curve = sampledFrom(bent, 1e-11);
    ASSERT_FALSE(curve.points.empty());
    EXPECT_LE(largestError(curve, bent), 2e-11) << power;
  }
}

TEST(SampledCurve, whatIsNoCurveIsNotKnown) {
  std::mt19937 random(1);
  std::uniform_real_distribution<double> noise(-1, 1);
  EXPECT_TRUE(sampledFrom([&](double t) { return Point(t, noise(random)); }, 1e-11).points.empty());
  EXPECT_TRUE(sampledFrom([](double t) { return Point(t, t < 0.3 ? 0 : 1); }, 1e-11).points.empty());
  EXPECT_TRUE(sampledFrom([](double) { return Point(NAN, 0); }, 1e-11).points.empty());
}

TEST(EdgeCurve, whereALineMeetsIt) {
  const auto parabola = [](double t) { return Point(4 * t - 2, 4 - (4 * t - 2) * (4 * t - 2)); };
  const auto whole = std::make_shared<const SampledCurve>(sampledFrom(parabola, 1e-12));
  for (const EdgeCurve& curve : {EdgeCurve{whole, 0.25, 1}, EdgeCurve{whole, 1, 0.25}}) {
    for (const double x : {-0.99, 0.0, 0.3, 1.9})
      EXPECT_NEAR((curve.at(curve.meeting({x, -7}, {0, 1})) - Point(x, 4 - x * x)).norm(), 0, 1e-12);
    EXPECT_EQ(curve.meeting({-1.5, 0}, {0, 1}), 0.25);  // beyond the stretch
    EXPECT_EQ(curve.meeting({2.5, 0}, {0, 1}), 1);
    const Point middle = curve.at(curve.middle());
    EXPECT_NEAR((middle - curve.at(curve.from)).norm(), (middle - curve.at(curve.to)).norm(), 1e-12);
  }
}

/// A quarter of a ring whose circles are squeezed into ellipses. Labels 1 and 2 know them.
TriangleMesh squeezedRing(double squeeze, int cells) {
  TriangleMesh mesh = annulusMesh({{0, 0}, 1, 2, 1, cells, 2});
  mesh.edgeMiddles.assign(mesh.boundaryEdges.size(), Point(NAN, NAN));
  mesh.edgeCurves.resize(mesh.boundaryEdges.size());
  for (size_t e = 0; e < mesh.boundaryEdges.size(); ++e) {
    const auto [a, b] = mesh.boundaryEdges[e];
    const Point from = mesh.vertices[a];
    const Point to = mesh.vertices[b];
    if (mesh.boundaryLabels[e] > 2) continue;
    const double begin = std::atan2(from.y(), from.x());
    const double end = std::atan2(to.y(), to.x());
    const auto at = [&](double t) {
      const double angle = (1 - t) * begin + t * end;
      return Point(from.norm() * Point(std::cos(angle), squeeze * std::sin(angle)));
    };
    mesh.edgeCurves[e].curve = std::make_shared<const SampledCurve>(sampledFrom(at, 1e-11));
    mesh.edgeMiddles[e] = mesh.edgeCurves[e].at(mesh.edgeCurves[e].middle());
  }
  for (Point& x : mesh.vertices) x.y() *= squeeze;
  return mesh;
}

double offEllipse(const Point& x, double radius, double squeeze) {
  return std::abs(Point(x.x(), x.y() / squeeze).norm() - radius);
}

TEST(EdgeCurve, refinedVerticesAndMiddlesAreOnIt) {
  constexpr double squeeze = 0.6;
  TriangleMesh mesh = squeezedRing(squeeze, 3);
  // Edges that a file has the wrong way round are turned, and their curves with them.
  for (size_t e = 0; e < mesh.boundaryEdges.size(); e += 2) {
    std::swap(mesh.boundaryEdges[e][0], mesh.boundaryEdges[e][1]);
    std::swap(mesh.edgeCurves[e].from, mesh.edgeCurves[e].to);
  }
  validate(mesh);
  std::mt19937 random(4);
  for (int round = 0; round < 15; ++round) {
    std::vector<char> marks(mesh.triangles.size(), 0);
    for (char& mark : marks) mark = random() % 6 == 0 ? 1 : 0;
    RefinedMesh next = bisect(mesh, {}, marks);
    EXPECT_TRUE(next.offCurve.empty());
    mesh = std::move(next.mesh);
    validate(mesh);
  }
  ASSERT_EQ(mesh.edgeCurves.size(), mesh.boundaryEdges.size());
  for (size_t e = 0; e < mesh.boundaryEdges.size(); ++e) {
    const int label = mesh.boundaryLabels[e];
    ASSERT_EQ(mesh.hasCurve(e), label <= 2);
    if (label > 2) continue;
    const auto& [a, b] = mesh.boundaryEdges[e];
    EXPECT_LE((mesh.edgeCurves[e].at(mesh.edgeCurves[e].from) - mesh.vertices[a]).norm(), 1e-14);
    EXPECT_LE((mesh.edgeCurves[e].at(mesh.edgeCurves[e].to) - mesh.vertices[b]).norm(), 1e-14);
    EXPECT_LE(offEllipse(mesh.vertices[a], label, squeeze), 1e-10);
    EXPECT_LE(offEllipse(mesh.edgeMiddles[e], label, squeeze), 1e-10);
    EXPECT_NEAR((mesh.edgeMiddles[e] - mesh.vertices[a]).norm(),
                (mesh.edgeMiddles[e] - mesh.vertices[b]).norm(), 1e-12);
  }
  EXPECT_GT(sidesWith(mesh, 1).size(), 20U);
}

// A flat layer whose inner edge bulges beyond it: what goes back to its chord has no curve any more.
TEST(EdgeCurve, aVertexThatWouldTurnATriangleOverStaysOnTheChord) {
  TriangleMesh mesh;
  mesh.vertices = {{0, 0}, {2, 0}, {1, 0.2}};
  mesh.triangles = {{0, 1, 2}};
  mesh.regions = {1};
  mesh.boundaryEdges = {{0, 1}, {1, 2}, {2, 0}};
  mesh.boundaryLabels = {1, 2, 2};
  const auto bulge = [](double t) { return Point(2 * t, 2 * t * (1 - t)); };
  mesh.edgeCurves.resize(3);
  mesh.edgeCurves[0].curve = std::make_shared<const SampledCurve>(sampledFrom(bulge, 1e-11));
  mesh.edgeMiddles = {bulge(0.5), Point(NAN, NAN), Point(NAN, NAN)};
  const RefinedMesh next = bisect(mesh, {}, {1});
  EXPECT_EQ(next.offCurve.size(), 1U);
  EXPECT_EQ(next.mesh.vertices.back(), Point(1, 0));
  for (size_t e = 0; e < next.mesh.boundaryEdges.size(); ++e) {
    EXPECT_FALSE(next.mesh.hasCurve(e));
    EXPECT_FALSE(next.mesh.edgeMiddles[e].allFinite());
  }
}

// Edges that a part of a mesh does not have take their curves with them.
TEST(EdgeCurve, partsOfAMeshKeepTheirs) {
  TriangleMesh mesh = squeezedRing(0.6, 4);
  for (size_t t = 0; t < mesh.triangles.size(); ++t) {
    double least = 2;
    for (const int v : mesh.triangles[t]) least = std::min(least, mesh.vertices[v].y());
    mesh.regions[t] = least < 0.3 ? 1 : 2;
  }
  validate(mesh);
  keepRegions(mesh, {"2"});
  validate(mesh);
  ASSERT_EQ(mesh.edgeCurves.size(), mesh.boundaryEdges.size());
  for (size_t e = 0; e < mesh.boundaryEdges.size(); ++e)
    if (mesh.hasCurve(e)) {
      const Point& first = mesh.vertices[mesh.boundaryEdges[e][0]];
      EXPECT_LE((mesh.edgeCurves[e].at(mesh.edgeCurves[e].from) - first).norm(), 1e-14);
    }
  EXPECT_FALSE(sidesWith(mesh, 1).empty());
}

}  // namespace mortier::sampled_curve_test
