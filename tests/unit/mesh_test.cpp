#include <gtest/gtest.h>

#include <cmath>

#include "mesh/boundary_line.h"
#include "mesh/generate.h"
#include "mesh/triangle_mesh.h"
#include "unit/messages.h"

namespace mortier::mesh_test {

TEST(TriangleMesh, measuresTriangles) {
  TriangleMesh mesh;
  mesh.vertices = {{0, 0}, {1, 0}, {0.5, std::sqrt(0.75)}, {4, 0}};
  mesh.triangles = {{0, 1, 2}, {0, 2, 1}, {0, 3, 2}};
  EXPECT_DOUBLE_EQ(doubleArea(mesh, 0), std::sqrt(0.75));
  EXPECT_DOUBLE_EQ(doubleArea(mesh, 1), -std::sqrt(0.75));
  EXPECT_NEAR(aspectRatio(mesh, 0), 1, 1e-15);
  EXPECT_NEAR(aspectRatio(mesh, 2), 4, 1e-15);
  EXPECT_EQ(extent(mesh), 4);
}

TEST(TriangleMesh, judgesAtEveryScale) {
  for (const double scale : {1e-100, 1e-9, 1e9, 1e100}) {
    TriangleMesh mesh = rectangleMesh({{0, 0}, {scale, 1e-6 * scale}, 3, 2});
    EXPECT_EQ(messageOf([&] { validate(mesh); }), "no error") << scale;
    mesh.vertices[0] = mesh.vertices[1];
    EXPECT_NE(messageOf([&] { validate(mesh); }).find("degenerate"), std::string::npos) << scale;
  }
  EXPECT_THROW(rectangleMesh({{0, 0}, {1e200, 1e200}, 1, 1}), InputError);
}

TEST(TriangleMesh, mayHaveFreeBoundary) {
  TriangleMesh mesh = rectangleMesh({});
  mesh.boundaryEdges.clear();
  EXPECT_NE(messageOf([&] { validate(mesh); }).find("numbers of labels"), std::string::npos);
  mesh.boundaryLabels.clear();
  EXPECT_NO_THROW(validate(mesh));
  EXPECT_NE(messageOf([&] { boundaryLine(mesh, 1); }).find("no edge is labelled"), std::string::npos);
}

TEST(BoundaryLine, runsWithTheBodyToItsLeft) {
  TriangleMesh mesh = rectangleMesh({{0, 0}, {3, 1}, 3, 1});
  std::swap(mesh.boundaryEdges[0], mesh.boundaryEdges[2]);        // the order in the mesh does not matter,
  std::swap(mesh.boundaryEdges[1][0], mesh.boundaryEdges[1][1]);  // nor does the direction
  validate(mesh);
  const BoundaryLine bottom = boundaryLine(mesh, 1), top = boundaryLine(mesh, 3);
  EXPECT_EQ(bottom.nodes, (std::vector<int>{0, 1, 2, 3}));
  EXPECT_EQ(top.nodes, (std::vector<int>{7, 6, 5, 4}));
  EXPECT_EQ(top.points.front(), Point(3, 1));
  EXPECT_FALSE(top.closed);
  EXPECT_EQ(boundaryLabels(mesh), (std::vector<int>{1, 2, 3, 4}));
  EXPECT_EQ(verticesOn(mesh, 3), (std::vector<int>{4, 5, 6, 7}));
  EXPECT_EQ(sidesWith(mesh, 2), (std::vector{std::array{3, 7}}));
  EXPECT_TRUE(sidesWith(mesh, 5).empty());
}

TEST(BoundaryLine, closesAroundTheBody) {
  TriangleMesh mesh = rectangleMesh({{0, 0}, {1, 1}, 2, 2});
  mesh.boundaryLabels.assign(mesh.boundaryLabels.size(), 5);
  const BoundaryLine line = boundaryLine(mesh, 5);
  EXPECT_TRUE(line.closed);
  EXPECT_EQ(line.nodes, (std::vector<int>{0, 1, 2, 5, 8, 7, 6, 3, 0}));
  EXPECT_EQ(line.points.front(), line.points.back());
}

TEST(BoundaryLine, refusesWhatIsNoLine) {
  TriangleMesh mesh = rectangleMesh({{0, 0}, {1, 1}, 2, 2});
  const auto fault = [&mesh](int label) { return messageOf([&] { boundaryLine(mesh, label); }); };
  EXPECT_NE(fault(9).find("boundary label 9 is missing, expected one of 1 2 3 4"), std::string::npos)
      << fault(9);
  for (int& label : mesh.boundaryLabels) label = label == 3 ? 1 : label;
  EXPECT_NE(fault(1).find("is not connected: vertex 1 at (0, 0) and vertex 9 at (1, 1)"), std::string::npos)
      << fault(1);

  // An open line and a ring around a hole: as many edges as vertices, still two pieces.
  TriangleMesh ring = rectangleMesh({{0, 0}, {3, 3}, 3, 3});
  ring.triangles.erase(ring.triangles.begin() + 8, ring.triangles.begin() + 10);
  ring.regions.resize(ring.triangles.size());
  for (const auto& edge : {std::array<int, 2>{5, 6}, {6, 10}, {10, 9}, {9, 5}}) {
    ring.boundaryEdges.push_back(edge);
    ring.boundaryLabels.push_back(1);
  }
  validate(ring);
  EXPECT_EQ(ring.boundaryEdges.back(), (std::array<int, 2>{5, 9})) << "clockwise around the hole";
  EXPECT_NE(messageOf([&] { boundaryLine(ring, 1); }).find("not connected"), std::string::npos);

  // Two triangles that meet in a vertex.
  mesh.vertices = {{0, 0}, {1, 0}, {0, 1}, {-1, 0}, {0, -1}};
  mesh.triangles = {{0, 1, 2}, {0, 3, 4}};
  mesh.boundaryEdges = {{0, 1}, {1, 2}, {2, 0}, {0, 3}, {3, 4}, {4, 0}};
  mesh.regions.assign(2, 0);
  mesh.boundaryLabels.assign(6, 1);
  validate(mesh);
  EXPECT_NE(fault(1).find("branches in vertex 1 at (0, 0)"), std::string::npos) << fault(1);
}

}  // namespace mortier::mesh_test
