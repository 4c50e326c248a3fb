#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "adapt/adapted_meshes.h"
#include "mesh/boundary_line.h"
#include "mesh/shape.h"

namespace mortier::adapt_test {

TriangleMesh square(int cells) {
  return crissCrossMesh({.lower = {0, 0}, .upper = {1, 1}, .cellsX = cells, .cellsY = cells});
}

TEST(Curves, circlesOfARingAreKnown) {
  for (const int quarters : {1, 2, 4}) {
    const TriangleMesh mesh = annulusMesh({{3, 4}, 1, 2.5, quarters, 6 * quarters, 3});
    const KnownCurves curves = curvesBehind(mesh);
    EXPECT_TRUE(curves.polygons.empty());
    EXPECT_EQ(curves.edges.size(), 12U * quarters);
    for (const auto& edge : sidesWith(mesh, 1)) EXPECT_NEAR(curves.edges.at(edge), -1, 1e-12);
    for (const auto& edge : sidesWith(mesh, 2)) EXPECT_NEAR(curves.edges.at(edge), 1 / 2.5, 1e-12);
  }
}

TEST(Curves, boundariesWithoutALabelHaveTheirCurvesToo) {
  TriangleMesh mesh = annulusMesh({{0, 0}, 1, 2, 4, 24, 3});
  mesh.boundaryEdges.clear();
  mesh.boundaryLabels.clear();
  EXPECT_EQ(curvesBehind(mesh).edges.size(), 48U);
}

TEST(Curves, lineBetweenRegionsHasItsCurve) {
  TriangleMesh mesh = annulusMesh({{0, 0}, 1, 2, 4, 24, 2});
  for (size_t t = 0; t < mesh.triangles.size(); ++t) {
    Point centre = Point::Zero();
    for (const int v : mesh.triangles[t]) centre += mesh.vertices[v] / 3;
    mesh.regions[t] = centre.norm() < std::sqrt(2.0) ? 1 : 2;
  }
  const KnownCurves curves = curvesBehind(mesh);
  EXPECT_EQ(curves.edges.size(), 72U);
  for (const auto& [edge, curvature] : curves.edges)
    EXPECT_NEAR(1 / std::abs(curvature), mesh.vertices[edge[0]].norm(), 1e-12);
}

TEST(Curves, rectanglesAreStraightAndKnown) {
  const KnownCurves curves = curvesBehind(square(3));
  EXPECT_TRUE(curves.edges.empty());
  EXPECT_TRUE(curves.polygons.empty());
}

TEST(Curves, anEllipseIsAPolygonThatIsNamed) {
  TriangleMesh mesh = annulusMesh({{0, 0}, 1, 2, 4, 24, 3});
  for (Point& x : mesh.vertices) x.y() *= 0.7;
  EXPECT_EQ(curvesBehind(mesh).polygons, (std::vector<std::string>{"label 1", "label 2"}));
}

TEST(Curves, shapesTellTheirCirclesOnAnyMesh) {
  const TriangleMesh mesh = shapeMesh({Annulus{{1, 1}, 1, 3, 4, 3, 1}});
  const KnownCurves curves = curvesBehind(mesh);
  EXPECT_TRUE(curves.polygons.empty());
  for (const auto& edge : sidesWith(mesh, 1)) EXPECT_NEAR(curves.edges.at(edge), -1, 1e-12);
  for (const auto& edge : sidesWith(mesh, 2)) EXPECT_NEAR(curves.edges.at(edge), 1.0 / 3, 1e-12);
  const TriangleMesh disc = shapeMesh({HalfDisc{{0, 0}, 2, 0.5, 1}, Cut::both});
  const KnownCurves arcs = curvesBehind(disc);
  EXPECT_EQ(arcs.edges.size(), sidesWith(disc, 1).size() + sidesWith(disc, 3).size());
  for (const auto& [edge, curvature] : arcs.edges) EXPECT_NEAR(curvature, 0.5, 1e-12);
}

std::vector<Vector> equalErrors(const AdaptedMeshes& meshes, double sum) {
  const auto triangles = static_cast<Eigen::Index>(meshes.mesh(0).triangles.size());
  return {Vector::Constant(triangles, sum / static_cast<double>(triangles))};
}

// eta_T ~ h^(p+1), the sum of squares ~ h^(2p): half the error is a quarter of the area at degree 1,
// half of it at degree 2.
TEST(AdaptedMeshes, equalErrorsMakeEqualSizesThatMeetTheAim) {
  for (const auto& [degree, pieces] : {std::pair(1, 4U), std::pair(2, 2U)}) {
    const TriangleMesh first = square(3);
    AdaptedMeshes meshes({first}, degree);
    meshes.refine(equalErrors(meshes, 1), 0.5);
    EXPECT_EQ(meshes.mesh(0).triangles.size(), pieces * first.triangles.size());
  }
}

// eta_T ~ h^(p+3/2): half the error is an eighth of the volume at degree 1, 0.35 of it at degree 2.
TEST(AdaptedMeshes, equalErrorsMakeEqualSizesInSpace) {
  for (const auto& [degree, pieces] : {std::pair(1, 8U), std::pair(2, 2U)}) {
    const TetrahedronMesh first = cuboidMesh({{0, 0, 0}, {1, 1, 1}, {2, 2, 2}});
    AdaptedMeshes meshes({first}, {CurvedFaces()}, degree);
    const auto count = static_cast<Eigen::Index>(first.tetrahedra.size());
    meshes.refine({Vector::Constant(count, 1.0 / static_cast<double>(count))}, 0.5);
    EXPECT_EQ(meshes.spaceMesh(0).tetrahedra.size(), pieces * first.tetrahedra.size());
    EXPECT_EQ(meshes.unknowns(), 3 * spaceNodes(meshes.spaceMesh(0), degree).count());
  }
}

TEST(AdaptedMeshes, noSizeFallsToLessThanAnEighth) {
  const TriangleMesh first = square(2);
  AdaptedMeshes meshes({first}, 1);
  meshes.refine(equalErrors(meshes, 1), 1e-6);
  EXPECT_EQ(meshes.mesh(0).triangles.size(), 64 * first.triangles.size());
}

// With the aim met already, those triangles that make half of the error are cut,
// and no others but for closure.
TEST(AdaptedMeshes, halfOfTheErrorIsCutWhateverElse) {
  const TriangleMesh first = square(8);
  AdaptedMeshes meshes({first, first}, 1);
  std::vector<Vector> errors(2, Vector::Constant(static_cast<Eigen::Index>(first.triangles.size()), 1e-6));
  errors[1][100] = 1;
  meshes.refine(errors, 2);
  EXPECT_EQ(meshes.mesh(0).triangles.size(), first.triangles.size());
  EXPECT_GT(meshes.mesh(1).triangles.size(), first.triangles.size());
  EXPECT_LE(meshes.mesh(1).triangles.size(), first.triangles.size() + 4);
}

// Sizes that differ are no error: only what has one is cut, whatever the elements beside it are like.
TEST(AdaptedMeshes, aGradedMeshIsNotCutWhereItHasNoError) {
  TetrahedronMesh graded = cuboidMesh({{0, 0, 0}, {1, 1, 1}, {2, 2, 2}});
  for (int i = 0; i < 15; ++i) {
    std::vector<char> marked;
    for (const auto& element : graded.tetrahedra)
      marked.push_back(std::find(element.begin(), element.end(), 0) != element.end() ? 1 : 0);
    graded = bisect(graded, {}, marked).mesh;
  }
  AdaptedMeshes meshes({graded}, {{}}, 1);
  const auto count = static_cast<Eigen::Index>(graded.tetrahedra.size());
  Vector error = Vector::Constant(count, 1e-12);
  for (Eigen::Index t = 0; t < count; ++t)
    for (const int v : graded.tetrahedra[static_cast<size_t>(t)])
      if (v == 0) error[t] = 1;
  meshes.refine({error}, 0.9 * std::sqrt(error.sum()));
  const std::vector<std::array<int, 4>>& after = meshes.spaceMesh(0).tetrahedra;
  for (const auto& element : graded.tetrahedra) {
    const bool isFar = std::all_of(element.begin(), element.end(), [&](int v) {
      return graded.vertices[static_cast<size_t>(v)].norm() > 0.3;
    });
    EXPECT_TRUE(!isFar || std::find(after.begin(), after.end(), element) != after.end());
  }
  EXPECT_GT(after.size(), graded.tetrahedra.size());
}

double smallestArea(const TriangleMesh& mesh) {
  double least = INFINITY;
  for (int t = 0; t < static_cast<int>(mesh.triangles.size()); ++t)
    least = std::min(least, doubleArea(mesh, t) / 2);
  return least;
}

/// Errors like area^s at the lower left corner, whatever the mesh, and small ones elsewhere.
std::vector<Vector> cornerErrors(const TriangleMesh& mesh, double s) {
  Vector errors = Vector::Constant(static_cast<Eigen::Index>(mesh.triangles.size()), 1e-9);
  for (size_t t = 0; t < mesh.triangles.size(); ++t)
    for (const int v : mesh.triangles[t])
      if (mesh.vertices[v].norm() == 0)
        errors[static_cast<Eigen::Index>(t)] = std::pow(doubleArea(mesh, static_cast<int>(t)), s);
  return {errors};
}

TEST(AdaptedMeshes, aTriangleThatIsAloneWithItsErrorIsCutToItsSize) {
  // Degree 2: the square of its error falls like the square of its area.
  for (const int reach : {8, 64, 1024}) {
    AdaptedMeshes meshes({square(8)}, 2);
    const TriangleMesh before = meshes.mesh(0);
    const auto triangles = static_cast<Eigen::Index>(before.triangles.size());
    Vector error = Vector::Constant(triangles, 1e-12);
    const int alone = 100;
    error[alone] = 1;
    meshes.refine({error}, std::sqrt(1.0 / reach));
    const double area = doubleArea(before, alone);
    const double wanted = area / std::sqrt(double(reach));
    const TriangleMesh& after = meshes.mesh(0);
    const auto inside = [&](const Point& x) {
      for (int k = 0; k < 3; ++k) {
        const Point& a = before.vertices[before.triangles[alone][k]];
        const Point& b = before.vertices[before.triangles[alone][(k + 1) % 3]];
        if ((b - a).x() * (x - a).y() - (b - a).y() * (x - a).x() < 0) return false;
      }
      return true;
    };
    int parts = 0;
    for (size_t t = 0; t < after.triangles.size(); ++t) {
      Point middle = Point::Zero();
      for (const int v : after.triangles[t]) middle += after.vertices[v] / 3;
      if (!inside(middle)) continue;
      ++parts;
      EXPECT_LE(doubleArea(after, static_cast<int>(t)), 1.5 * wanted);
    }
    EXPECT_GE(parts, std::sqrt(double(reach)) / 1.5);
  }
}

TEST(AdaptedMeshes, trianglesAtAnUnboundedStressAreCutInLayers) {
  const auto smallest = [](double s) {
    AdaptedMeshes meshes({square(4)}, 2);
    for (int round = 0; round < 3; ++round) {
      const std::vector<Vector> errors = cornerErrors(meshes.mesh(0), s);
      meshes.refine(errors, 0.5 * std::sqrt(errors[0].sum()));
    }
    return smallestArea(meshes.mesh(0)) / smallestArea(square(4));
  };
  EXPECT_LT(smallest(0.5), 2e-3);
  EXPECT_GT(smallest(1.5), 1e-2);
}

// As where data or contact were not resolved on the meshes before.
TEST(AdaptedMeshes, slowRatesBesideALargerErrorMakeNoLayers) {
  AdaptedMeshes meshes({square(4)}, 2);
  for (int round = 0; round < 3; ++round) {
    const TriangleMesh& mesh = meshes.mesh(0);
    Vector errors(static_cast<Eigen::Index>(mesh.triangles.size()));
    for (size_t t = 0; t < mesh.triangles.size(); ++t) {
      Point middle = Point::Zero();
      for (const int v : mesh.triangles[t]) middle += mesh.vertices[v] / 3;
      errors[static_cast<Eigen::Index>(t)] =
          std::exp(-6 * middle.norm()) * std::sqrt(doubleArea(mesh, static_cast<int>(t)));
    }
    meshes.refine({errors}, 0.9 * std::sqrt(errors.sum()));
  }
  const TriangleMesh& mesh = meshes.mesh(0);
  double least = INFINITY;
  for (int t = 0; t < static_cast<int>(mesh.triangles.size()); ++t)
    if (mesh.vertices[mesh.triangles[t][0]].norm() > 0.3) least = std::min(least, doubleArea(mesh, t) / 2);
  EXPECT_GT(least / smallestArea(square(4)), 0.1);
}

TEST(FacingCorners, linesGetVerticesWhereCornersFaceTheInsideOfAnEdge) {
  TriangleMesh wide = rectangleMesh({.lower = {-1, -1}, .upper = {1, 0}, .cellsX = 2, .cellsY = 1});
  const TriangleMesh narrow = rectangleMesh({.lower = {-0.01, 0}, .upper = {0.25, 1}});
  const std::vector<Point> corners = cornersOf(narrow, 1);
  ASSERT_EQ(corners.size(), 2U);
  const size_t before = wide.vertices.size();
  const size_t triangles = wide.triangles.size();
  cutFacing(wide, {}, 3, corners);  // the corner at -0.01 is next to a vertex
  ASSERT_EQ(wide.vertices.size(), before + 1);
  EXPECT_EQ(wide.triangles.size(), triangles + 1);
  EXPECT_EQ(wide.vertices.back(), Point(0.25, 0));
  EXPECT_EQ(verticesOn(wide, 3).size(), 4U);
  EXPECT_NO_THROW(validate(wide));
  double area = 0;
  for (size_t t = 0; t < wide.triangles.size(); ++t) area += doubleArea(wide, static_cast<int>(t)) / 2;
  EXPECT_NEAR(area, 2, 1e-14);
  // What is curved, or far away, stays.
  const size_t now = wide.vertices.size();
  cutFacing(wide, {}, 3, {{-0.5, 3}});
  CurvedEdges curves;
  for (const auto& edge : sidesWith(wide, 3)) curves[edge] = 0.1;
  cutFacing(wide, curves, 3, {{-0.5, 0}});
  EXPECT_EQ(wide.vertices.size(), now);
}

TEST(FacingCorners, edgesAreCutUntilTheyAreNoLongerThanTwiceThoseThatTheyFace) {
  AdaptedMeshes meshes({rectangleMesh({.lower = {-0.5, 0}, .upper = {0.5, 1}}),
                        rectangleMesh({.lower = {-2, -1}, .upper = {2, 0}, .cellsX = 32, .cellsY = 8})},
                       1);
  meshes.faceSizes(0, 1, 1, 3);
  for (const auto& [a, b] : sidesWith(meshes.mesh(0), 1))
    EXPECT_EQ((meshes.mesh(0).vertices[b] - meshes.mesh(0).vertices[a]).norm(), 0.25);
  TriangleMesh cut = meshes.mesh(0);
  EXPECT_NO_THROW(validate(cut));
  const size_t triangles = meshes.mesh(1).triangles.size();
  meshes.faceSizes(1, 3, 0, 1);  // these are shorter, and nothing faces the others
  EXPECT_EQ(meshes.mesh(1).triangles.size(), triangles);
}

TEST(FacingCorners, roundLinesHaveNone) {
  EXPECT_TRUE(cornersOf(annulusMesh({{0, 0}, 1, 2, 4, 24, 3}), 2).empty());
  EXPECT_EQ(cornersOf(annulusMesh({{0, 0}, 1, 2, 1, 6, 3}), 2).size(), 2U);
}

}  // namespace mortier::adapt_test
