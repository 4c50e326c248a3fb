// Meshes of the plane that are extruded or turned: volumes and areas of the polygons that they are, labels.
#include "mesh/read.h"

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>
#include <set>

#include "base/error.h"
#include "mesh/shape.h"
#include "mesh/simplices.h"
#include "unit/space_meshes.h"

namespace mortier::swept_mesh_test {

constexpr double right = std::numbers::pi / 2;

double areaOf(const TetrahedronMesh& mesh, int label) {
  double sum = 0;
  for (const auto& [a, b, c] : sidesWith(mesh, label))
    sum += (mesh.vertices[b] - mesh.vertices[a]).cross(mesh.vertices[c] - mesh.vertices[a]).norm() / 2;
  return sum;
}

double areaOf(const TriangleMesh& mesh) {
  double sum = 0;
  for (size_t t = 0; t < mesh.triangles.size(); ++t) sum += doubleArea(mesh, static_cast<int>(t)) / 2;
  return sum;
}

double lengthOf(const TriangleMesh& mesh, int label) {
  double sum = 0;
  for (size_t e = 0; e < mesh.boundaryEdges.size(); ++e) {
    const auto& [a, b] = mesh.boundaryEdges[e];
    if (mesh.boundaryLabels[e] == label) sum += (mesh.vertices[b] - mesh.vertices[a]).norm();
  }
  return sum;
}

TEST(SweptMesh, extrudedShapesHaveTheirVolumeAndTheirSides) {
  for (const MeshShape& shape :
       {MeshShape{Rectangle{{-1, 2}, {2, 4}, 3, 2}}, MeshShape{Annulus{{1, 1}, 1, 2, 1, 4, 2}, Cut::both},
        MeshShape{Annulus{{0, 0}, 1, 2, 4, 9, 1}, Cut::falling},
        MeshShape{HalfDisc{{0, 0}, 1, 0.1, 2, false}},
        MeshShape{Quadrilateral{{Point(0, 0), {4, 1}, {4, 2}, {0, 3}}, 2, 3}, Cut::both}}) {
    const TriangleMesh plane = shapeMesh(shape);
    const TetrahedronMesh mesh = sweptMesh(plane, {3, 0, 4});
    EXPECT_NEAR(volumeOf(mesh), 3 * areaOf(plane), 1e-13 * volumeOf(mesh));
    EXPECT_EQ(mesh.tetrahedra.size(), 12 * plane.triangles.size());
    EXPECT_EQ(mesh.vertices.size(), 5 * plane.vertices.size());
    const std::set<int> labels(plane.boundaryLabels.begin(), plane.boundaryLabels.end());
    for (const int label : labels)
      EXPECT_NEAR(areaOf(mesh, label), 3 * lengthOf(plane, label), 1e-13 * areaOf(mesh, label));
    for (const char* name : {"start", "end"})
      EXPECT_NEAR(areaOf(mesh, mesh.labelNames.at(name)), areaOf(plane), 1e-13 * areaOf(plane));
    EXPECT_EQ(mesh.labelNames.at("start"), *labels.rbegin() + 1);
    EXPECT_EQ(mesh.labelNames.at("end"), *labels.rbegin() + 2);
    // Nothing of the boundary is without a label.
    EXPECT_EQ(outerTriangles(mesh).size(), mesh.boundaryTriangles.size());
    for (const int v : verticesOn(mesh, mesh.labelNames.at("start"))) EXPECT_EQ(mesh.vertices[v].z(), 0);
    for (const int v : verticesOn(mesh, mesh.labelNames.at("end"))) EXPECT_EQ(mesh.vertices[v].z(), 3);
  }
}

TEST(SweptMesh, turnedShapesHaveTheVolumeOfTheirPolygons) {
  const TriangleMesh ring = shapeMesh({Rectangle{{1, 0}, {3, 2}, 3, 2}, Cut::both});
  const TriangleMesh full = shapeMesh({Rectangle{{0, 0}, {3, 2}, 3, 2}, Cut::both});
  for (const auto& [angle, layers] : std::vector<std::pair<double, int>>{
           {right, 3}, {0.7, 1}, {2 * right, 4}, {3 * right, 5}, {4 * right, 7}, {6.283185307, 3}}) {
    const bool closed = angle > 6;
    const double sector = std::sin(angle / layers) / 2 * layers;  // of radius 1
    const TetrahedronMesh tube = sweptMesh(ring, {0, angle, layers});
    EXPECT_NEAR(volumeOf(tube), 2 * sector * (9 - 1), closed ? 1e-8 : 1e-12);
    EXPECT_EQ(tube.tetrahedra.size(), 3 * layers * ring.triangles.size());
    EXPECT_EQ(tube.labelNames.count("start"), closed ? 0U : 1U);
    EXPECT_EQ(outerTriangles(tube).size(), tube.boundaryTriangles.size());
    const TetrahedronMesh disc = sweptMesh(full, {0, angle, layers});
    EXPECT_NEAR(volumeOf(disc), 2 * sector * 9, closed ? 1e-8 : 1e-12);
    // The axis is a line inside, or an edge between the ends.
    EXPECT_EQ(sidesWith(disc, 4).size(), 0U);
    EXPECT_NEAR(areaOf(disc, 3), sector * 9, closed ? 1e-8 : 1e-12);
    EXPECT_NEAR(areaOf(disc, 2), layers * 2 * 2 * 3 * std::sin(angle / layers / 2), closed ? 1e-8 : 1e-12);
    EXPECT_EQ(outerTriangles(disc).size(), disc.boundaryTriangles.size());
  }
}

// Where a right angle ends, coordinates are 0 and not rounding.
TEST(SweptMesh, rightAnglesAreExact) {
  const TetrahedronMesh mesh = sweptMesh(shapeMesh({Rectangle{{0, 0}, {3, 2}, 2, 2}}), {0, right, 5});
  for (const int v : verticesOn(mesh, mesh.labelNames.at("end"))) EXPECT_EQ(mesh.vertices[v].x(), 0);
  for (const int v : verticesOn(mesh, mesh.labelNames.at("start"))) EXPECT_EQ(mesh.vertices[v].z(), 0);
  for (const SpacePoint& x : mesh.vertices) EXPECT_GE(std::min(x.x(), x.z()), 0);
}

TEST(SweptMesh, regionsAndNamesStay) {
  TriangleMesh plane = shapeMesh({Rectangle{{0, 0}, {2, 1}, 2, 1}});
  plane.regions = {7, 7, 9, 9};
  plane.regionNames = {{"left", 7}, {"right", 9}};
  plane.labelNames = {{"floor", 1}, {"start", 12}};
  const TetrahedronMesh mesh = sweptMesh(plane, {1, 0, 2});
  for (size_t e = 0; e < mesh.tetrahedra.size(); ++e) {
    double x = 0;
    for (const int v : mesh.tetrahedra[e]) x += mesh.vertices[v].x() / 4;
    EXPECT_EQ(mesh.regions[e], x < 1 ? 7 : 9);
  }
  EXPECT_EQ(mesh.regionNames, plane.regionNames);
  EXPECT_EQ(mesh.labelNames.at("floor"), 1);
  EXPECT_EQ(mesh.labelNames.at("start"), 12);  // a name that is taken stays, the plane has a number only
  EXPECT_NEAR(areaOf(mesh, 13), 2, 1e-14);
  EXPECT_EQ(mesh.labelNames.at("end"), 14);
}

TEST(SweptMesh, whatIsWrongIsNamed) {
  const TriangleMesh plane = shapeMesh({Rectangle{{-1, 0}, {2, 1}, 2, 1}});
  EXPECT_THROW(sweptMesh(plane, {0, 1, 2}), InputError);
  EXPECT_NO_THROW(sweptMesh(plane, {1, 0, 2}));
  const TriangleMesh beside = shapeMesh({Rectangle{{0, 0}, {2, 1}, 2, 1}});
  EXPECT_THROW(sweptMesh(beside, {0, 4 * right, 2}), InputError);
  EXPECT_THROW(sweptMesh(beside, {0, 2 * right, 1}), InputError);
}

}  // namespace mortier::swept_mesh_test
