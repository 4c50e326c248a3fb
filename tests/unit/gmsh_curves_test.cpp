// Curves of Gmsh that are no circles: vertices of refined meshes and middles of edges lie on them.
// A build without Gmsh skips them, which ./check takes for a fault.
#include <gtest/gtest.h>
#include <unistd.h>

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <fstream>
#include <numbers>
#include <sstream>

#include "adapt/adapted_meshes.h"
#include "base/error.h"
#include "contact/interface.h"
#include "mesh/boundary_line.h"
#include "mesh/read.h"
#include "unit/mesh_measures.h"

namespace mortier::gmsh_curves_test {

/// Of the size of a curve: far below what a mesh of a million edges is off it, far above rounding.
constexpr double onCurve = 1e-10;

TriangleMesh meshOf(const std::string& geometry) {
  const std::string path = testing::TempDir() + "gmsh_curves_test_" + std::to_string(getpid()) + ".geo";
  std::ofstream(path) << geometry;
  const auto removed = [&] { std::remove(path.c_str()); };
  try {
    TriangleMesh mesh = readMesh(MeshSource{path});
    removed();
    return mesh;
  } catch (const InputError&) {
    removed();
    throw;
  }
}

class GmshCurves : public testing::Test {
 protected:
  void SetUp() override {
    try {
      meshOf("");
    } catch (const InputError& error) {
      if (std::string(error.what()).find("this build is without") != std::string::npos)
        GTEST_SKIP() << "this build is without Gmsh";
    }
  }
};

struct Ellipse {
  double a = 2, b = 1;
  double angle = 0;
  Point centre = {0, 0};

  [[nodiscard]] Point at(double x, double y) const {
    return centre +
           Point(x * std::cos(angle) - y * std::sin(angle), x * std::sin(angle) + y * std::cos(angle));
  }
  /// How far a point near it is off it [m].
  [[nodiscard]] double off(const Point& point) const {
    const Point from = point - centre;
    const Point local(from.x() * std::cos(angle) + from.y() * std::sin(angle),
                      from.y() * std::cos(angle) - from.x() * std::sin(angle));
    const double value = std::pow(local.x() / a, 2) + std::pow(local.y() / b, 2) - 1;
    return std::abs(value) / (2 * Point(local.x() / (a * a), local.y() / (b * b)).norm());
  }
  /// What lies inside, its four arcs label 1.
  [[nodiscard]] std::string inside(double size) const {
    std::ostringstream text;
    text.precision(17);
    const Point points[] = {at(0, 0), at(a, 0), at(0, b), at(-a, 0), at(0, -b)};
    for (int i = 0; i < 5; ++i)
      text << "Point(" << i + 1 << ") = {" << points[i].x() << ", " << points[i].y() << ", 0, " << size
           << "};\n";
    text << "Ellipse(1) = {2, 1, 2, 3}; Ellipse(2) = {3, 1, 2, 4}; Ellipse(3) = {4, 1, 2, 5};\n"
            "Ellipse(4) = {5, 1, 2, 2}; Curve Loop(1) = {1, 2, 3, 4}; Plane Surface(1) = {1};\n"
            "Physical Curve(1) = {1, 2, 3, 4}; Physical Surface(1) = {1};\n";
    return text.str();
  }
};

/// Of the domain inside the edges bent through their middles, as quadratic triangles have it.
double bentArea(const TriangleMesh& mesh) {
  double sum = area(mesh);
  for (size_t e = 0; e < mesh.boundaryEdges.size(); ++e) {
    const Point& a = mesh.vertices[mesh.boundaryEdges[e][0]];
    const Point chord = mesh.vertices[mesh.boundaryEdges[e][1]] - a;
    const Point bow = mesh.edgeMiddles[e] - a - chord / 2;
    sum += 2.0 / 3 * (bow.x() * chord.y() - bow.y() * chord.x());
  }
  return sum;
}

TEST_F(GmshCurves, refinedMeshesTendToTheEllipse) {
  for (const Ellipse& ellipse : {Ellipse{}, Ellipse{2, 1, 0.4, {5, -3}}, Ellipse{2e-6, 1e-6, 0.4, {1e-6, 0}},
                                 Ellipse{3e5, 0.5e5, 1}}) {
    const auto mesh = meshOf(ellipse.inside(0.5 * ellipse.b));
    AdaptedMeshes meshes({mesh}, 1);
    EXPECT_TRUE(meshes.polygons(0).empty());
    const double exact = std::numbers::pi * ellipse.a * ellipse.b;
    double last = 0;
    double lastBent = 0;
    for (int level = 0; level < 4; ++level) {
      const TriangleMesh& now = meshes.mesh(0);
      for (const int v : verticesOn(now, 1)) EXPECT_LE(ellipse.off(now.vertices[v]), onCurve * ellipse.a);
      for (const Point& middle : now.edgeMiddles) EXPECT_LE(ellipse.off(middle), onCurve * ellipse.a);
      const double error = std::abs(area(now) / exact - 1);
      const double errorBent = std::abs(bentArea(now) / exact - 1);
      if (level > 1) {
        EXPECT_NEAR(std::log2(last / error), 2, 0.2);
        EXPECT_NEAR(std::log2(lastBent / errorBent), 4, 0.6);
      }
      last = error;
      lastBent = errorBent;
      meshes.refineAll();
      meshes.refineAll();
    }
    EXPECT_LT(lastBent, 1e-6);
    EXPECT_TRUE(meshes.offCurve(0).empty());
  }
}

// A closed curve of OpenCASCADE's begins and ends at one node.
TEST_F(GmshCurves, closedCurveOfACadModel) {
  const auto mesh = meshOf(
      "SetFactory(\"OpenCASCADE\"); Ellipse(1) = {0, 0, 0, 2, 1}; Curve Loop(1) = {1};\n"
      "Plane Surface(1) = {1}; Mesh.MeshSizeMax = 0.6; Physical Curve(1) = {1}; Physical Surface(1) = "
      "{1};\n");
  AdaptedMeshes meshes({mesh}, 2);
  for (int i = 0; i < 4; ++i) meshes.refineAll();
  const TriangleMesh& now = meshes.mesh(0);
  for (const int v : verticesOn(now, 1)) EXPECT_LE(Ellipse{}.off(now.vertices[v]), 2 * onCurve);
  for (const Point& middle : now.edgeMiddles) EXPECT_LE(Ellipse{}.off(middle), 2 * onCurve);
  EXPECT_NEAR(bentArea(now), 2 * std::numbers::pi, 1e-5);
}

/// A plate between a curve from (0, 0) to (4, 0), number 1, and a straight line at a height; the size is
/// that of the edges at the curve.
std::string beside(const std::string& curve, double size, double height = -2) {
  std::ostringstream text;
  const double points[][2] = {{0, 0}, {4, 0}, {4, height}, {0, height}, {1, 1}, {2, -0.5}, {3, 1}};
  for (int i = 0; i < 7; ++i)
    text << "Point(" << i + 1 << ") = {" << points[i][0] << ", " << points[i][1] << ", 0, "
         << (i == 2 || i == 3 ? 1 : size) << "};\n";
  text << curve
       << "\nLine(2) = {2, 3}; Line(3) = {3, 4}; Line(4) = {4, 1}; Curve Loop(1) = {1, 2, 3, 4};\n"
          "Plane Surface(1) = {1}; Physical Curve(1) = {1}; Physical Curve(2) = {3}; Physical Surface(1) = "
          "{1};\n";
  return text.str();
}

double distanceTo(const TriangleMesh& mesh, const Point& x) {
  double least = std::numeric_limits<double>::infinity();
  for (size_t e = 0; e < mesh.boundaryEdges.size(); ++e) {
    if (mesh.boundaryLabels[e] != 1) continue;
    const Point chord = mesh.vertices[mesh.boundaryEdges[e][1]] - mesh.vertices[mesh.boundaryEdges[e][0]];
    const EdgeCurve& curve = mesh.edgeCurves.at(e);
    least = std::min(least, (curve.at(curve.meeting(x, {-chord.y(), chord.x()})) - x).norm());
  }
  return least;
}

// The nodes of a fine mesh are on the curve; those of a coarse one know it nevertheless, knots between them
// and all.
TEST_F(GmshCurves, splinesAreKnownBetweenTheNodes) {
  for (const std::string kernel : {"", "SetFactory(\"OpenCASCADE\"); "})
    for (const std::string kind : {"Spline", "BSpline", "Bezier"}) {
      const std::string curve = kind + "(1) = {1, 5, 6, 7, 2};";
      const auto coarse = meshOf(kernel + beside(curve, 0.7));
      const auto fine = meshOf(kernel + beside(curve, 0.05));
      for (const int v : verticesOn(fine, 1))
        EXPECT_LE(distanceTo(coarse, fine.vertices[v]), 4 * onCurve) << kernel << kind;
      AdaptedMeshes meshes({coarse}, 1);
      EXPECT_TRUE(meshes.polygons(0).empty());
      for (int i = 0; i < 6; ++i) meshes.refineAll();
      for (const int v : verticesOn(meshes.mesh(0), 1))
        EXPECT_LE(distanceTo(fine, meshes.mesh(0).vertices[v]), 4 * onCurve) << kernel << kind;
    }
}

// The polynomial that Bezier's curve is, by its formula.
TEST_F(GmshCurves, bezierCurveIsItsPolynomial) {
  const auto mesh = meshOf(beside("Bezier(1) = {1, 5, 6, 2};", 0.7));
  AdaptedMeshes meshes({mesh}, 1);
  for (int i = 0; i < 6; ++i) meshes.refineAll();
  const Point p[] = {{0, 0}, {1, 1}, {2, -0.5}, {4, 0}};
  for (const int v : verticesOn(meshes.mesh(0), 1)) {
    const Point& x = meshes.mesh(0).vertices[v];
    const auto at = [&](double t) {
      const double s = 1 - t;
      return Point(s * s * s * p[0] + 3 * s * s * t * p[1] + 3 * s * t * t * p[2] + t * t * t * p[3]);
    };
    double low = 0;
    double high = 1;
    for (int i = 0; i < 60; ++i) (at((low + high) / 2).x() < x.x() ? low : high) = (low + high) / 2;
    EXPECT_NEAR(at(low).y(), x.y(), 4 * onCurve);
  }
}

// A spline that is a line, as CAD files have them, is a line.
TEST_F(GmshCurves, straightSplinesAndLinesAreStraight) {
  const auto mesh =
      meshOf(beside("Point(8) = {1, 0, 0, 0.7}; Point(9) = {3, 0, 0, 0.7}; BSpline(1) = {1, 8, 9, 2};", 0.7));
  EXPECT_TRUE(mesh.edgeCurves.empty());
  for (size_t e = 0; e < mesh.boundaryEdges.size(); ++e) EXPECT_TRUE(isStraight(mesh, e)) << e;
  AdaptedMeshes meshes({mesh}, 1);
  for (int i = 0; i < 4; ++i) meshes.refineAll();
  for (const int v : verticesOn(meshes.mesh(0), 1)) EXPECT_NEAR(meshes.mesh(0).vertices[v].y(), 0, 1e-14);
  for (size_t e = 0; e < meshes.mesh(0).boundaryEdges.size(); ++e)
    EXPECT_TRUE(isStraight(meshes.mesh(0), e)) << e;
}

TEST_F(GmshCurves, circlesStayArcs) {
  const auto mesh = meshOf(beside("Point(8) = {2, -3, 0, 0.7}; Circle(1) = {1, 8, 2};", 0.7));
  EXPECT_TRUE(mesh.edgeCurves.empty());
  EXPECT_FALSE(mesh.edgeMiddles.empty());
}

// Each meshed on its own: the distance of the curves, not of the polygons, whatever the displacements.
TEST_F(GmshCurves, twoMeshesOfOneCurveTouch) {
  const std::string curve = "BSpline(1) = {1, 5, 6, 7, 2};";
  const auto lower = meshOf(beside(curve, 0.23));
  const auto upper = meshOf(beside(curve, 0.31, 3));
  for (const int degree : {1, 2})
    for (const CouplingKind kind :
         {CouplingKind::interpolation, CouplingKind::mortar, CouplingKind::weighted}) {
      const ContactInterface interface({{0, 1}, {1, 1}, kind}, {lower, elementNodes(lower, degree)},
                                       {upper, elementNodes(upper, degree)});
      EXPECT_EQ(interface.sagitta(), 0);
      EXPECT_GT(interface.rows(), 10);
      EXPECT_LE(interface.initialDistance().cwiseAbs().maxCoeff(), 1e-9) << degree;
    }
}

TEST_F(GmshCurves, geometriesThatDoNotEndAreRefused) {
  const std::string path = testing::TempDir() + "gmsh_curves_test_" + std::to_string(getpid()) + ".geo";
  std::ofstream(path) << "i = 0;\nFor n In {1 : 1000000000}\ni = i + 1;\nEndFor\n";
  try {
    readGmsh({path}, 0.5);
    ADD_FAILURE() << "it has ended";
  } catch (const InputError& error) {
    const std::string message = error.what();
    EXPECT_EQ(message, path + ": Gmsh has not ended with it after 0.5 s, expected a file that takes less");
  }
  std::remove(path.c_str());
}

}  // namespace mortier::gmsh_curves_test
