// Meshes of tetrahedra: files, regions, places of messages, and the curved surfaces that they stand for.
#include <gtest/gtest.h>

#include <cmath>
#include <filesystem>
#include <fstream>
#include <numbers>

#include "base/error.h"
#include "contact/surface.h"
#include "fem/body.h"
#include "material/deviatoric.h"
#include "material/stress.h"
#include "mesh/element_sides.h"
#include "mesh/read.h"
#include "mesh/regions.h"
#include "unit/space_meshes.h"

namespace mortier::space_mesh_test {

class SpaceMesh : public testing::Test {
 protected:
  std::string write(const std::string& name, const std::string& text) {
    const std::string path = (folder_ / name).string();
    std::ofstream(path) << text;
    return path;
  }
  void SetUp() override {
    folder_ = std::filesystem::path(testing::TempDir()) /
              ("space-mesh-" + std::string(testing::UnitTest::GetInstance()->current_test_info()->name()));
    std::filesystem::create_directories(folder_);
  }
  void TearDown() override { std::filesystem::remove_all(folder_); }

  std::filesystem::path folder_;
};

/// Half of the box has region 2.
TetrahedronMesh twoRegions() {
  TetrahedronMesh mesh = cuboidMesh({{0, 0, 0}, {2, 1, 1}, {2, 1, 1}});
  for (size_t e = 0; e < mesh.tetrahedra.size(); ++e) {
    double x = 0;
    for (const int v : mesh.tetrahedra[e]) x += mesh.vertices[v].x() / 4;
    mesh.regions[e] = x < 1 ? 1 : 2;
  }
  mesh.regionNames = {{"first", 1}, {"second", 2}};
  return mesh;
}

TEST_F(SpaceMesh, isReadAsWritten) {
  TetrahedronMesh mesh = twoRegions();
  mesh.vertices[3] += SpacePoint(0.1 / 3, -1e-17, 1 / 7.0);
  const std::string path = (folder_ / "box.mesh").string();
  writeMedit(mesh, path);
  const TetrahedronMesh read = readSpaceMesh({path});
  EXPECT_EQ(read.vertices, mesh.vertices);
  EXPECT_EQ(read.tetrahedra, mesh.tetrahedra);
  EXPECT_EQ(read.regions, mesh.regions);
  EXPECT_EQ(read.boundaryTriangles, mesh.boundaryTriangles);
  EXPECT_EQ(read.boundaryLabels, mesh.boundaryLabels);
  EXPECT_EQ(read.labelNames, mesh.labelNames);
  EXPECT_EQ(read.regionNames, mesh.regionNames);
}

TEST_F(SpaceMesh, keepsRegions) {
  TetrahedronMesh mesh = twoRegions();
  keepRegions(mesh, {"second"});
  EXPECT_EQ(mesh.tetrahedra.size(), 6U);
  EXPECT_EQ(mesh.vertices.size(), 8U);
  EXPECT_NEAR(volumeOf(mesh), 1, 1e-15);
  EXPECT_EQ(boundaryLabels(mesh), (std::vector<int>{1, 2, 3, 5, 6}));  // what was inside has no label
  EXPECT_EQ(sidesWith(mesh, 3).size(), 2U);
  EXPECT_NO_THROW(validate(mesh));
  EXPECT_THROW(keepRegions(mesh, {"third"}), InputError);
}

TEST_F(SpaceMesh, labelsInsideAreDropped) {
  TetrahedronMesh mesh = twoRegions();
  const size_t labelled = mesh.boundaryTriangles.size();
  std::vector<int> middle;
  for (size_t v = 0; v < mesh.vertices.size(); ++v)
    if (mesh.vertices[v].x() == 1) middle.push_back(static_cast<int>(v));
  const auto sides = sortedSides(mesh);
  for (size_t i = 0; i < middle.size(); ++i)
    for (size_t j = i + 1; j < middle.size(); ++j)
      for (size_t k = j + 1; k < middle.size(); ++k)
        if (sidesOn(sides, {middle[i], middle[j], middle[k]}).size() == 2) {
          mesh.boundaryTriangles.push_back({middle[i], middle[j], middle[k]});
          mesh.boundaryLabels.push_back(7);
        }
  EXPECT_EQ(mesh.boundaryTriangles.size(), labelled + 2);
  dropInnerSides(mesh);
  EXPECT_EQ(mesh.boundaryTriangles.size(), labelled);
}

TEST_F(SpaceMesh, wrongFilesAreNamedWithTheirLine) {
  const std::string head =
      "MeshVersionFormatted 2\nDimension 3\nVertices\n4\n0 0 0 0\n1 0 0 0\n0 1 0 0\n0 0 1 0\n";
  const std::string element = "Tetrahedra\n1\n1 2 3 4 1\n";
  const auto messageOf = [&](const std::string& text) {
    try {
      readSpaceMesh({write("a.mesh", text)});
    } catch (const InputError& error) {
      return std::string(error.what());
    }
    return std::string("accepted");
  };
  EXPECT_EQ(messageOf(head + element + "End\n"), "accepted");
  EXPECT_NE(messageOf("MeshVersionFormatted 2\nDimension 2\n").find("a.mesh:2: Dimension 2, expected 3"),
            std::string::npos);
  EXPECT_NE(messageOf(head + element + "Hexahedra\n1\n1 2 3 4 5 6 7 8 1\nEnd\n").find("expected 1 to 4"),
            std::string::npos);
  EXPECT_NE(messageOf(head + element + "Tangents").find("a.mesh:12: end of file"), std::string::npos);
  EXPECT_EQ(messageOf(head + element), "accepted");
  EXPECT_NE(messageOf(head + "Tetrahedra\n1\n1 2 3 9 1\nEnd\n").find("vertex 9, expected 1 to 4"),
            std::string::npos);
  EXPECT_NE(messageOf(head + "Tetrahedra\n1\n1 2 3 3 1\nEnd\n").find("no tetrahedron"), std::string::npos);
  EXPECT_NE(messageOf(head + "Triangles\n1\n1 2 3 1\nEnd\n").find("no tetrahedra"), std::string::npos);
  // A mesh of tetrahedra in the plane.
  try {
    readMesh({write("b.mesh", head + element + "End\n")});
    FAIL();
  } catch (const InputError& error) {
    EXPECT_NE(std::string(error.what()).find("expected all vertices in the plane"), std::string::npos);
  }
}

TEST_F(SpaceMesh, gmshMeshesGeometries) {
  MeshSource source{write("box.geo", R"(SetFactory("OpenCASCADE");
DefineConstant[ H = 2 ];
Box(1) = {0, 0, 0, 1, 1, H};
Box(2) = {0, 0, H, 1, 1, 1};
BooleanFragments{ Volume{1}; Delete; }{ Volume{2}; Delete; }
Physical Volume("lower", 1) = Volume In BoundingBox{-1, -1, -1, 2, 2, H + 0.1};
Physical Volume("upper", 2) = Volume In BoundingBox{-1, -1, H - 0.1, 2, 2, H + 2};
Physical Surface("between", 5) = Surface In BoundingBox{-1, -1, H - 0.1, 2, 2, H + 0.1};
Physical Surface("floor", 3) = Surface In BoundingBox{-1, -1, -0.1, 2, 2, 0.1};
)")};
  source.size = 0.5;
  const TetrahedronMesh both = readSpaceMesh(source);
  EXPECT_NEAR(volumeOf(both), 3, 1e-12);
  EXPECT_EQ(boundaryLabels(both), (std::vector<int>{3}));
  source.regions = {"lower"};
  source.parameters["H"] = 3;
  const TetrahedronMesh lower = readSpaceMesh(source);
  EXPECT_NEAR(volumeOf(lower), 3, 1e-12);
  EXPECT_EQ(boundaryLabels(lower), (std::vector<int>{3, 5}));
  EXPECT_EQ(lower.labelNames.at("between"), 5);
}

// What the triangles of a sphere are off it is known from their vertices: the rest is of fourth order.
TEST_F(SpaceMesh, surfacesOfSpheresAreKnown) {
  double before = 0;
  for (const int cells : {4, 8}) {
    const TetrahedronMesh mesh = quarterBall(cells);
    const ContactSurface surface(mesh, spaceNodes(mesh, 1), 1);
    double sagitta = 0;
    double off = 0;
    double normal = 0;
    for (size_t t = 0; t < surface.triangles.size(); ++t) {
      const Eigen::Vector3d l(0.2, 0.5, 0.3);
      SpacePoint x = SpacePoint::Zero();
      for (int k = 0; k < 3; ++k) {
        x += l[k] * surface.places[t][k];
        normal = std::max(normal, (surface.vertexNormals[t][k].n - surface.places[t][k]).norm());
      }
      sagitta = std::max(sagitta, 1 - x.norm());
      off = std::max(off, std::abs((x + surface.offset(static_cast<int>(t), l)).norm() - 1));
    }
    EXPECT_LE(normal, 1e-13);
    EXPECT_LE(off, 0.05 * sagitta);
    if (before > 0) {
      EXPECT_LE(off, before / 12);
    }
    before = off;
  }
}

// R1 n1 - R2 n2 = c2 - c1 + x1 - x2 of two spheres: the line through the points is that of their centres.
TEST_F(SpaceMesh, spheresFaceEachOtherAlongTheLineOfTheirCentres) {
  const TetrahedronMesh upper = quarterBall(8);
  for (const double radius : {0.5, 1.0, 4.0}) {
    TetrahedronMesh lower = quarterBall(10);
    for (SpacePoint& x : lower.vertices) x = radius * x - SpacePoint(0, 0, 1 + radius);
    const ContactSurface nonmortar(upper, spaceNodes(upper, 1), 1);
    const ContactSurface mortar(lower, spaceNodes(lower, 1), 1);
    const TriangleTree tree(mortar);
    int tried = 0;
    for (size_t t = 0; t < nonmortar.triangles.size(); ++t)
      for (int k = 0; k < 3; ++k) {
        const SpacePoint& x = nonmortar.places[t][k];
        if (x.z() > 0 || x.head<2>().norm() > 0.4 * std::min(1.0, radius)) continue;
        const SpacePoint n =
            tree.contactDirection(x, nonmortar.vertexNormals[t][k].n, nonmortar.curvatures[t][k], 1, true);
        EXPECT_NEAR(n.z(), -1, 1e-4) << radius << ": " << x.transpose();
        ++tried;
      }
    EXPECT_GT(tried, 10);
  }
}

double areaOf(const TetrahedronMesh& mesh, int label) {
  double sum = 0;
  for (const auto& [a, b, c] : sidesWith(mesh, label))
    sum += (mesh.vertices[b] - mesh.vertices[a]).cross(mesh.vertices[c] - mesh.vertices[a]).norm() / 2;
  return sum;
}

/// Volumes and areas converge with the square of the cells; round sides have their vertices on the surface,
/// and no tetrahedron is much flatter than those of a cube.
TEST_F(SpaceMesh, ballsAndCylindersAreRound) {
  const SpacePoint centre(1, -2, 3);
  const double pi = std::numbers::pi;
  for (const bool ball : {true, false})
    for (const std::array<int, 3>& keep :
         {std::array{0, 0, 0}, {1, 0, 0}, {-1, 1, 0}, {1, 1, ball ? -1 : 0}, {-1, -1, 0}}) {
      double part = 1;
      for (const int half : keep) part *= half == 0 ? 1 : 0.5;
      double before = 0;
      for (const int cells : {4, 8}) {
        const TetrahedronMesh mesh = roundMesh({ball, centre, 2, 3, keep, {cells, 3 * cells / 2}});
        const double volume = part * (ball ? 4 * pi / 3 * 8 : pi * 4 * 3);
        const double area = part * (ball ? 4 * pi * 4 : 2 * pi * 2 * 3);
        const double off = 1 - volumeOf(mesh) / volume;
        EXPECT_GT(off, 0);
        if (before > 0) {
          EXPECT_LT(off, 0.3 * before);
          EXPECT_NEAR(areaOf(mesh, 7) / area, 1, 0.02);
          const std::array flat{keep[0] > 0 ? 4 : 2, keep[1] > 0 ? 5 : 6, 3};
          for (int axis = 0; axis < 3; ++axis)
            EXPECT_NEAR(keep[axis] == 0 ? 0 : areaOf(mesh, flat[axis]),
                        keep[axis] == 0 ? 0 : (ball ? 4 * pi : 12) * 2 * part, 0.6);
        }
        before = off;
        for (const int v : verticesOn(mesh, 7)) {
          SpacePoint x = mesh.vertices[v] - centre;
          if (!ball) x.z() = 0;
          EXPECT_NEAR(x.norm(), 2, 1e-14);
        }
        double worst = 1;
        for (const auto& tetrahedron : mesh.tetrahedra) {
          double longest = 0;
          for (const auto& [a, b] : sidesOfTetrahedron)
            longest =
                std::max(longest, (mesh.vertices[tetrahedron[a]] - mesh.vertices[tetrahedron[b]]).norm());
          worst = std::min(worst, mortier::volume(mesh, tetrahedron) / std::pow(longest, 3));
        }
        EXPECT_GT(worst, 0.02) << ball << ' ' << cells;
      }
    }
}

/// Of a region in place of that of the body, component by component; and temperatures beside.
TEST_F(SpaceMesh, initialStressesAndExpansionsAreThoseOfRegions) {
  TetrahedronMesh mesh = twoRegions();
  const std::vector<int> regions = mesh.regions;
  const auto constant = [](double value) {
    return [value](const SpacePoint& /*x*/, double /*t*/) { return value; };
  };
  Conditions conditions;
  conditions.initialStresses = {{0, {}, constant(5)},
                                {3, {}, constant(1)},
                                {0, 2, constant(7)},
                                {5, 1, constant(3)},
                                {2, 2, constant(4)}};
  conditions.temperature = [](const SpacePoint& x, double t) { return t * x.z(); };
  const auto count = static_cast<Eigen::Index>(4 * regions.size());
  conditions.expansion = Matrix::Zero(6, count);
  for (Eigen::Index i = 0; i < count; ++i) conditions.expansion(5, i) = regions[i / 4];
  const Body body("box", std::move(mesh), elasticMaterial({1, 0.3}, Plane::none), conditions, 2);
  ASSERT_TRUE(body.hasInitialStress() && body.heated());
  const Matrix stress = body.initialStress();
  const Matrix strain = body.thermalStrain(3);
  for (Eigen::Index i = 0; i < count; ++i) {
    const bool first = regions[i / 4] == 1;
    const SpaceStress expected = first ? SpaceStress{5, 0, 1, 0, 0, 3} : SpaceStress{7, 0, 1, 4, 0, 0};
    EXPECT_LE((toSpaceCartesian(stress.col(i)) - expected).norm(), 1e-14) << i;
    EXPECT_NEAR(strain(5, i), (first ? 3 : 6) * body.placeOfPoint(static_cast<int>(i)).z(), 1e-14);
    EXPECT_EQ(strain.col(i).head<5>().norm(), 0);
  }
}

}  // namespace mortier::space_mesh_test
