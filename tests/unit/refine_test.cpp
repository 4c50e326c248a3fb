#include "mesh/refine.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <numbers>
#include <random>

#include "mesh/boundary_line.h"
#include "mesh/generate.h"
#include "unit/mesh_measures.h"

namespace mortier::refine_test {

/// Conforming, triangles counterclockwise, every edge of one triangle labelled, as it was before.
void expectSound(TriangleMesh mesh) {
  const auto edges = mesh.boundaryEdges;
  validate(mesh);
  EXPECT_EQ(mesh.boundaryEdges, edges) << "orientation";
  std::map<std::pair<int, int>, int> count;
  for (const auto& t : mesh.triangles)
    for (int k = 0; k < 3; ++k) ++count[std::minmax(t[k], t[(k + 1) % 3])];
  const auto single =
      std::count_if(count.begin(), count.end(), [](const auto& edge) { return edge.second == 1; });
  EXPECT_EQ(single, static_cast<std::ptrdiff_t>(mesh.boundaryEdges.size())) << "a vertex inside an edge";
}

TriangleMesh cooksMembrane() {
  TriangleMesh mesh = quadrilateralMesh({{Point(0, 0), {48, 44}, {48, 60}, {0, 44}}, 3, 2});
  for (size_t t = 0; t < mesh.triangles.size(); ++t) mesh.regions[t] = t < 5 ? 4 : 9;
  mesh.labelNames = {{"foot", 1}};
  mesh.regionNames = {{"soft", 4}};
  return mesh;
}

std::vector<char> randomMarks(const TriangleMesh& mesh, std::mt19937& random) {
  std::vector<char> marks(mesh.triangles.size());
  for (char& mark : marks) mark = random() % 20 == 0 ? 1 : 0;
  marks[random() % marks.size()] = 1;
  return marks;
}

// Isosceles triangles have two longest sides but for rounding.
TEST(Refine, basesDependNeitherOnUnitsNorOnRotations) {
  TriangleMesh mesh = rectangleMesh({.lower = {0, 0}, .upper = {1.1, 0.7}, .cellsX = 11, .cellsY = 7});
  for (Point& v : mesh.vertices) v.x() -= v.y() / 2;
  TriangleMesh other = mesh;
  const double c = std::cos(0.3);
  const double s = std::sin(0.3);
  for (Point& v : other.vertices) v = 0.21 * Point(c * v.x() - s * v.y(), s * v.x() + c * v.y());
  std::mt19937 random(2);
  for (int round = 0; round < 5; ++round) {
    const std::vector<char> marks = randomMarks(mesh, random);
    mesh = bisect(mesh, {}, marks).mesh;
    other = bisect(other, {}, marks).mesh;
  }
  EXPECT_EQ(mesh.triangles, other.triangles);
}

double lengthOn(const TriangleMesh& mesh, int label) {
  double length = 0;
  for (const auto& [a, b] : sidesWith(mesh, label)) length += (mesh.vertices[b] - mesh.vertices[a]).norm();
  return length;
}

double areaOf(const TriangleMesh& mesh, int region) {
  double sum = 0;
  for (size_t t = 0; t < mesh.triangles.size(); ++t)
    if (mesh.regions[t] == region) sum += doubleArea(mesh, static_cast<int>(t)) / 2;
  return sum;
}

bool within(const TriangleMesh& mesh, int t, const Point& x) {
  for (int k = 0; k < 3; ++k) {
    const Point& a = mesh.vertices[mesh.triangles[t][k]];
    const Point along = mesh.vertices[mesh.triangles[t][(k + 1) % 3]] - a;
    if (along.x() * (x - a).y() - along.y() * (x - a).x() <= 0) return false;
  }
  return true;
}

TEST(Refine, oneTriangleIsCutInTwo) {
  TriangleMesh mesh = rectangleMesh({.lower = {0, 0}, .upper = {2, 1}, .cellsX = 1, .cellsY = 1});
  const RefinedMesh cut = bisect(mesh, {}, {1, 0});
  // Both triangles have the diagonal as their base.
  EXPECT_EQ(cut.mesh.triangles.size(), 4U);
  EXPECT_EQ(cut.parents, (std::vector<int>{0, 0, 1, 1}));
  EXPECT_EQ(cut.mesh.vertices.back(), Point(1, 0.5));
  EXPECT_EQ(cut.mesh.vertices.size(), mesh.vertices.size() + 1);
  EXPECT_EQ(cut.mesh.boundaryEdges, mesh.boundaryEdges);
  EXPECT_TRUE(cut.mesh.edgeMiddles.empty());
}

TEST(Refine, nothingMarkedIsNothingCut) {
  const TriangleMesh mesh = cooksMembrane();
  const RefinedMesh same = bisect(mesh, {}, std::vector<char>(mesh.triangles.size(), 0));
  EXPECT_EQ(same.mesh.triangles.size(), mesh.triangles.size());
  EXPECT_EQ(same.mesh.vertices, mesh.vertices);
  expectSound(same.mesh);
}

/// [rad]
double smallestAngle(const TriangleMesh& mesh, int triangle) {
  const auto& t = mesh.triangles[triangle];
  double least = std::numbers::pi;
  for (int k = 0; k < 3; ++k) {
    const Point one = mesh.vertices[t[(k + 1) % 3]] - mesh.vertices[t[k]];
    const Point other = mesh.vertices[t[(k + 2) % 3]] - mesh.vertices[t[k]];
    least = std::min(least, std::acos(one.normalized().dot(other.normalized())));
  }
  return least;
}

double smallestAngle(const TriangleMesh& mesh) {
  double least = std::numbers::pi;
  for (int t = 0; t < static_cast<int>(mesh.triangles.size()); ++t)
    least = std::min(least, smallestAngle(mesh, t));
  return least;
}

// Rosenberg and Stenger 1975: no angle is less than half of the smallest one.
TEST(Refine, twentyRandomRoundsKeepAllThatCountsAndHalfOfTheSmallestAngle) {
  const TriangleMesh first = cooksMembrane();
  for (const unsigned seed : {1U, 2U, 3U}) {
    std::mt19937 random(seed);
    TriangleMesh mesh = first;
    for (int round = 0; round < 20; ++round) {
      const RefinedMesh next = bisect(mesh, {}, randomMarks(mesh, random));
      ASSERT_EQ(next.parents.size(), next.mesh.triangles.size());
      for (size_t v = 0; v < mesh.vertices.size(); ++v) ASSERT_EQ(next.mesh.vertices[v], mesh.vertices[v]);
      for (size_t t = 0; t < next.parents.size(); ++t) {
        const auto& [a, b, c] = next.mesh.triangles[t];
        const Point centre = (next.mesh.vertices[a] + next.mesh.vertices[b] + next.mesh.vertices[c]) / 3;
        ASSERT_TRUE(within(mesh, next.parents[t], centre));
        ASSERT_EQ(next.mesh.regions[t], mesh.regions[next.parents[t]]);
      }
      mesh = next.mesh;
      expectSound(mesh);
    }
    EXPECT_GT(mesh.triangles.size(), 5 * first.triangles.size());
    EXPECT_NEAR(area(mesh), area(first), 1e-12 * area(first));
    EXPECT_GE(smallestAngle(mesh), smallestAngle(first) / 2);
    for (const int label : {1, 2, 3, 4}) EXPECT_NEAR(lengthOn(mesh, label), lengthOn(first, label), 1e-11);
    for (const int region : {4, 9}) EXPECT_NEAR(areaOf(mesh, region), areaOf(first, region), 1e-9);
    EXPECT_EQ(mesh.labelNames, first.labelNames);
    EXPECT_EQ(mesh.regionNames, first.regionNames);
    EXPECT_EQ(mesh.name, first.name);
  }
}

// With newest-vertex bisection all of them would be as long as the first ones.
TEST(Refine, longTrianglesBecomeFewer) {
  TriangleMesh mesh = rectangleMesh({.lower = {0, 0}, .upper = {4, 1}, .cellsX = 1, .cellsY = 1});
  for (int round = 0; round < 6; ++round)
    mesh = bisect(mesh, {}, std::vector<char>(mesh.triangles.size(), 1)).mesh;
  expectSound(mesh);
  int longOnes = 0;
  for (int t = 0; t < static_cast<int>(mesh.triangles.size()); ++t)
    if (smallestAngle(mesh, t) < std::atan(0.4)) ++longOnes;
  EXPECT_LT(longOnes, 0.4 * static_cast<double>(mesh.triangles.size()));
}

TEST(Refine, everyMarkedTriangleIsCut) {
  std::mt19937 random(5);
  const TriangleMesh mesh = cooksMembrane();
  const std::vector<char> marks = randomMarks(mesh, random);
  const RefinedMesh next = bisect(mesh, {}, marks);
  for (size_t t = 0; t < marks.size(); ++t)
    EXPECT_GE(std::count(next.parents.begin(), next.parents.end(), static_cast<int>(t)),
              marks[t] != 0 ? 2 : 1);
}

/// Of an annulus: positive where the body is convex.
CurvedEdges circlesOf(const TriangleMesh& mesh, double inner, double outer) {
  CurvedEdges curves;
  for (const auto& edge : sidesWith(mesh, 1)) curves[edge] = -1 / inner;
  for (const auto& edge : sidesWith(mesh, 2)) curves[edge] = 1 / outer;
  return curves;
}

TEST(Refine, verticesOfArcsLieOnTheirCircles) {
  constexpr double inner = 0.7;
  constexpr double outer = 3;
  const Point centre(5, -2);
  for (const int quarters : {1, 2, 4}) {
    TriangleMesh mesh = annulusMesh({centre, inner, outer, quarters, 2 * quarters, 2});
    CurvedEdges curves = circlesOf(mesh, inner, outer);
    std::mt19937 random(7);
    for (int round = 0; round < 20; ++round) {
      RefinedMesh next = bisect(mesh, curves, randomMarks(mesh, random));
      EXPECT_TRUE(next.offCurve.empty());
      mesh = std::move(next.mesh);
      curves = std::move(next.curves);
      expectSound(mesh);
    }
    EXPECT_GT(mesh.triangles.size(), 100U);
    for (const auto& [label, radius] : {std::pair(1, inner), std::pair(2, outer)}) {
      EXPECT_GT(sidesWith(mesh, label).size(), static_cast<size_t>(2 * quarters));
      for (const int v : verticesOn(mesh, label))
        EXPECT_NEAR((mesh.vertices[v] - centre).norm(), radius, 1e-14 * outer + 1e-14 * centre.norm());
    }
    ASSERT_EQ(mesh.edgeMiddles.size(), mesh.boundaryEdges.size());
    for (size_t e = 0; e < mesh.boundaryEdges.size(); ++e) {
      const int label = mesh.boundaryLabels[e];
      EXPECT_EQ(mesh.edgeMiddles[e].allFinite(), label <= 2);
      if (label > 2) continue;
      EXPECT_NEAR((mesh.edgeMiddles[e] - centre).norm(), label == 1 ? inner : outer, 1e-13);
    }
  }
}

TEST(Refine, areaOfARingTendsToThatOfItsCircles) {
  TriangleMesh mesh = annulusMesh({{0, 0}, 1, 2, 4, 8, 1});
  CurvedEdges curves = circlesOf(mesh, 1, 2);
  double last = std::abs(area(mesh) - 3 * std::numbers::pi);
  for (int level = 0; level < 4; ++level) {
    for (int half = 0; half < 2; ++half) {
      RefinedMesh next = bisect(mesh, curves, std::vector<char>(mesh.triangles.size(), 1));
      mesh = std::move(next.mesh);
      curves = std::move(next.curves);
    }
    const double error = std::abs(area(mesh) - 3 * std::numbers::pi);
    EXPECT_LT(error, last / 3.5);
    last = error;
  }
}

// One layer of cells whose inner chords bulge into the body by more than its thickness there: where the inner
// edge alone is cut, its new vertex on the arc would lie beyond the outer chord.
TEST(Refine, aVertexStaysOnTheChordWhereATriangleWouldTurnOver) {
  TriangleMesh mesh = annulusMesh({{0, 0}, 1, 1.04, 4, 6, 1});
  CurvedEdges curves = circlesOf(mesh, 1, 1.04);
  int offCurve = 0;
  std::mt19937 random(3);
  for (int round = 0; round < 20; ++round) {
    RefinedMesh next = bisect(mesh, curves, randomMarks(mesh, random));
    offCurve += static_cast<int>(next.offCurve.size());
    mesh = std::move(next.mesh);
    curves = std::move(next.curves);
    expectSound(mesh);
  }
  EXPECT_GT(offCurve, 0);
}

TEST(Refine, knownMiddlesOfEdgesGoOn) {
  TriangleMesh mesh = annulusMesh({{0, 0}, 1, 2, 1, 4, 2});
  mesh.edgeMiddles.assign(mesh.boundaryEdges.size(), Point(NAN, NAN));
  for (size_t e = 0; e < mesh.boundaryEdges.size(); ++e)
    if (mesh.boundaryLabels[e] == 2) mesh.edgeMiddles[e] = Point(7, static_cast<double>(e));
  std::vector<char> marks(mesh.triangles.size(), 0);
  marks[0] = 1;
  const TriangleMesh next = bisect(mesh, {}, marks).mesh;
  int kept = 0;
  for (size_t e = 0; e < next.boundaryEdges.size(); ++e) {
    const auto before =
        std::find(mesh.boundaryEdges.begin(), mesh.boundaryEdges.end(), next.boundaryEdges[e]);
    if (next.boundaryLabels[e] != 2 || before == mesh.boundaryEdges.end()) continue;
    EXPECT_EQ(next.edgeMiddles[e], mesh.edgeMiddles[before - mesh.boundaryEdges.begin()]);
    ++kept;
  }
  EXPECT_GT(kept, 0);
}

}  // namespace mortier::refine_test
