#include "mesh/refine.h"

#include <gtest/gtest.h>

#include <random>

#include <Eigen/Geometry>

#include "adapt/adapted_meshes.h"
#include "mesh/read.h"
#include "mesh/simplices.h"
#include "unit/space_meshes.h"

namespace mortier::refine_space_test {

/// Conforming, of positive volumes, the whole boundary labelled, as it was before.
void expectSound(TetrahedronMesh mesh) {
  for (const auto& tetrahedron : mesh.tetrahedra) ASSERT_GT(volume(mesh, tetrahedron), 0);
  const auto triangles = mesh.boundaryTriangles;
  ASSERT_NO_THROW(validate(mesh));
  EXPECT_EQ(mesh.boundaryTriangles, triangles) << "orientation";
  EXPECT_EQ(outerTriangles(mesh).size(), triangles.size()) << "a vertex inside an edge or a triangle";
}

double areaOn(const TetrahedronMesh& mesh, int label) {
  double sum = 0;
  for (const auto& [a, b, c] : sidesWith(mesh, label)) {
    const SpacePoint& x = mesh.vertices[a];
    sum += (mesh.vertices[b] - x).cross(mesh.vertices[c] - x).norm() / 2;
  }
  return sum;
}

/// The least volume over the cube of the longest edge, times that of a regular tetrahedron.
double worstShape(const TetrahedronMesh& mesh) {
  double worst = INFINITY;
  for (const auto& tetrahedron : mesh.tetrahedra) {
    double longest = 0;
    for (const auto& [a, b] : sidesOfTetrahedron)
      longest = std::max(longest, (mesh.vertices[tetrahedron[b]] - mesh.vertices[tetrahedron[a]]).norm());
    worst = std::min(worst, 6 * std::sqrt(2) * volume(mesh, tetrahedron) / std::pow(longest, 3));
  }
  return worst;
}

std::vector<char> randomMarks(const TetrahedronMesh& mesh, std::mt19937& random) {
  std::vector<char> marks(mesh.tetrahedra.size());
  for (char& mark : marks) mark = random() % 60 == 0 ? 1 : 0;
  marks[random() % marks.size()] = 1;
  return marks;
}

/// A box of two regions whose inner vertices are anywhere, more or less.
TetrahedronMesh irregularBox(unsigned seed) {
  TetrahedronMesh mesh = cuboidMesh({{0, 0, 0}, {3, 1, 1}, {6, 3, 2}});
  std::mt19937 random(seed);
  std::uniform_real_distribution<double> shift(-0.06, 0.06);
  std::vector<char> outer(mesh.vertices.size(), 0);
  for (const auto& triangle : mesh.boundaryTriangles)
    for (const int v : triangle) outer[v] = 1;
  for (size_t v = 0; v < mesh.vertices.size(); ++v)
    if (outer[v] == 0) mesh.vertices[v] += SpacePoint(shift(random), shift(random), shift(random));
  for (size_t t = 0; t < mesh.tetrahedra.size(); ++t) mesh.regions[t] = t < 30 ? 4 : 9;
  mesh.labelNames = {{"foot", 1}};
  mesh.regionNames = {{"soft", 4}};
  return mesh;
}

double volumeOf(const TetrahedronMesh& mesh, int region) {
  double sum = 0;
  for (size_t t = 0; t < mesh.tetrahedra.size(); ++t)
    if (mesh.regions[t] == region) sum += volume(mesh, mesh.tetrahedra[t]);
  return sum;
}

TEST(RefineSpace, allTetrahedraOfAnEdgeAreCut) {
  const TetrahedronMesh mesh = cuboidMesh({{0, 0, 0}, {1, 1, 1}, {1, 1, 1}});
  const RefinedTetrahedra next = bisect(mesh, {}, {0, 1, 0, 0, 0, 0});
  EXPECT_EQ(next.mesh.tetrahedra.size(), 12U);  // all six have the diagonal
  EXPECT_EQ(next.parents, (std::vector<int>{0, 0, 1, 1, 2, 2, 3, 3, 4, 4, 5, 5}));
  EXPECT_EQ(next.mesh.vertices.back(), SpacePoint(0.5, 0.5, 0.5));
  EXPECT_EQ(next.mesh.vertices.size(), mesh.vertices.size() + 1);
  EXPECT_EQ(next.mesh.boundaryTriangles, mesh.boundaryTriangles);
  EXPECT_EQ(bisect(mesh, {}, std::vector<char>(6, 0)).mesh.tetrahedra, mesh.tetrahedra);
}

// There is no proof of a bound for longest edges; Kuhn's tetrahedra have three shapes.
TEST(RefineSpace, randomRoundsKeepAllThatCountsAndBoundTheShape) {
  for (const unsigned seed : {1U, 2U, 3U}) {
    const TetrahedronMesh first = irregularBox(seed);
    TetrahedronMesh mesh = first;
    std::mt19937 random(seed);
    const double shape = worstShape(first);
    for (int round = 0; round < 14; ++round) {
      const RefinedTetrahedra next = bisect(mesh, {}, randomMarks(mesh, random));
      ASSERT_EQ(next.parents.size(), next.mesh.tetrahedra.size());
      for (size_t v = 0; v < mesh.vertices.size(); ++v) ASSERT_EQ(next.mesh.vertices[v], mesh.vertices[v]);
      std::vector<double> pieces(mesh.tetrahedra.size(), 0);
      for (size_t t = 0; t < next.parents.size(); ++t) {
        pieces[next.parents[t]] += volume(next.mesh, next.mesh.tetrahedra[t]);
        ASSERT_EQ(next.mesh.regions[t], mesh.regions[next.parents[t]]);
      }
      for (size_t t = 0; t < pieces.size(); ++t)
        ASSERT_NEAR(pieces[t], volume(mesh, mesh.tetrahedra[t]), 1e-15);
      mesh = next.mesh;
      expectSound(mesh);
    }
    std::cout << mesh.tetrahedra.size() << " tetrahedra, shape " << shape << " to " << worstShape(mesh)
              << "\n";
    EXPECT_GT(mesh.tetrahedra.size(), 5 * first.tetrahedra.size());
    EXPECT_GE(worstShape(mesh), shape / 4);
    EXPECT_NEAR(mortier::volumeOf(mesh), 3, 1e-12);
    for (const int label : {1, 2, 3, 4, 5, 6}) EXPECT_NEAR(areaOn(mesh, label), areaOn(first, label), 1e-12);
    for (const int region : {4, 9}) EXPECT_NEAR(volumeOf(mesh, region), volumeOf(first, region), 1e-12);
    EXPECT_EQ(mesh.labelNames, first.labelNames);
    EXPECT_EQ(mesh.regionNames, first.regionNames);
    EXPECT_EQ(mesh.name, first.name);
  }
  TetrahedronMesh kuhn = cuboidMesh({{0, 0, 0}, {1, 1, 1}, {2, 2, 2}});
  const double shape = worstShape(kuhn);
  for (int round = 0; round < 18; ++round) {  // towards a corner
    std::vector<char> marks(kuhn.tetrahedra.size(), 0);
    for (size_t t = 0; t < marks.size(); ++t)
      for (const int v : kuhn.tetrahedra[t]) marks[t] = marks[t] != 0 || v == 0 ? 1 : 0;
    kuhn = bisect(kuhn, {}, marks).mesh;
    expectSound(kuhn);
  }
  EXPECT_GE(worstShape(kuhn), 0.9 * shape);
}

TEST(RefineSpace, dependsNeitherOnUnitsNorOnRotations) {
  const Eigen::Matrix3d turn =
      (Eigen::AngleAxisd(0.7, SpacePoint(1, 2, 3).normalized()) * Eigen::AngleAxisd(2, SpacePoint::UnitX()))
          .toRotationMatrix();
  for (const bool ball : {false, true}) {
    TetrahedronMesh mesh = ball ? quarterBall(3) : cuboidMesh({{0, 0, 0}, {1.1, 0.7, 0.9}, {11, 7, 9}});
    TetrahedronMesh other = mesh;
    for (SpacePoint& v : other.vertices) v = 0.21 * (turn * v);
    CurvedFaces curves = curvesBehind(mesh);
    CurvedFaces otherCurves = curvesBehind(other);
    std::mt19937 random(3);
    for (int round = 0; round < 6; ++round) {
      const std::vector<char> marks = randomMarks(mesh, random);
      RefinedTetrahedra next = bisect(mesh, curves, marks);
      RefinedTetrahedra otherNext = bisect(other, otherCurves, marks);
      mesh = std::move(next.mesh);
      curves = std::move(next.curves);
      other = std::move(otherNext.mesh);
      otherCurves = std::move(otherNext.curves);
      ASSERT_EQ(mesh.tetrahedra, other.tetrahedra);
      for (size_t v = 0; v < mesh.vertices.size(); ++v)
        ASSERT_LE((0.21 * (turn * mesh.vertices[v]) - other.vertices[v]).norm(), 1e-14);
    }
  }
}

TEST(RefineSpace, planeBodiesHaveNoCurves) {
  EXPECT_TRUE(curvesBehind(irregularBox(1)).triangles.empty());
}

/// A column whose top is a part of the sphere of radius 1 about the origin.
TetrahedronMesh domed(int cells) {
  TetrahedronMesh mesh = cuboidMesh({{0, 0, 0}, {0.5, 0.5, 1}, {cells, cells, 2 * cells}});
  for (SpacePoint& x : mesh.vertices) x.z() *= std::sqrt(1 - x.x() * x.x() - x.y() * x.y());
  return mesh;
}

// Exact where the normals are: at sides of symmetry that are held, and inside. Normals where the sphere ends
// at another side are less good; its circles there stay in their planes.
TEST(RefineSpace, verticesOfASphereLieOnIt) {
  TetrahedronMesh mesh = domed(4);
  const double sagitta = 1 - std::cos(0.5 / 4 / 2 * 1.6);
  const double shape = worstShape(mesh);
  CurvedFaces curves = curvesBehind(mesh);
  std::mt19937 random(7);
  for (int round = 0; round < 7; ++round) {
    const std::vector<char> marks =
        round < 4 ? std::vector<char>(mesh.tetrahedra.size(), 1) : randomMarks(mesh, random);
    RefinedTetrahedra next = bisect(mesh, curves, marks);
    EXPECT_TRUE(next.offCurve.empty());
    mesh = std::move(next.mesh);
    curves = std::move(next.curves);
    expectSound(mesh);
  }
  double inner = 0;
  double outer = 0;
  for (const int v : verticesOn(mesh, 3)) {
    const SpacePoint& x = mesh.vertices[v];
    const bool exact = std::max(x.x(), x.y()) <= 0.375;
    double& worst = exact ? inner : outer;
    worst = std::max(worst, std::abs(x.norm() - 1));
  }
  EXPECT_LE(inner, 1e-14);
  EXPECT_GT(outer, 0);
  EXPECT_LE(outer, 0.3 * sagitta);
  std::cout << "off the sphere " << inner << ", " << outer << ", sagitta " << sagitta << "\n";
  for (const auto& [label, side] : {std::pair(2, 0), std::pair(6, 1)})
    for (const int v : verticesOn(mesh, label)) EXPECT_NEAR(mesh.vertices[v][side], 0.5, 1e-15);
  for (const auto& [label, side] : {std::pair(4, 0), std::pair(5, 1)})
    for (const int v : verticesOn(mesh, label)) EXPECT_EQ(mesh.vertices[v][side], 0);
  EXPECT_GE(worstShape(mesh), shape / 4);
}

// What has no label is a side of its own.
TEST(RefineSpace, sidesWithoutLabelsAreCurvedToo) {
  TetrahedronMesh mesh = domed(4);
  const CurvedFaces labelled = curvesBehind(mesh);
  TetrahedronMesh bare = mesh;
  for (size_t i = bare.boundaryTriangles.size(); i-- > 0;)
    if (bare.boundaryLabels[i] == 3) {
      bare.boundaryTriangles.erase(bare.boundaryTriangles.begin() + static_cast<std::ptrdiff_t>(i));
      bare.boundaryLabels.erase(bare.boundaryLabels.begin() + static_cast<std::ptrdiff_t>(i));
    }
  const CurvedFaces without = curvesBehind(bare);
  EXPECT_EQ(without.triangles.size(), labelled.triangles.size());
  const std::vector<char> all(mesh.tetrahedra.size(), 1);
  const RefinedTetrahedra one = bisect(mesh, labelled, all);
  const RefinedTetrahedra other = bisect(bare, without, all);
  ASSERT_EQ(one.mesh.tetrahedra, other.mesh.tetrahedra);
  for (size_t v = 0; v < one.mesh.vertices.size(); ++v)
    EXPECT_LE((one.mesh.vertices[v] - other.mesh.vertices[v]).norm(), 1e-14);
  EXPECT_EQ(one.mesh.boundaryTriangles.size() - other.mesh.boundaryTriangles.size(),
            sidesWith(one.mesh, 3).size());
}

// A thin shell whose inner vertices would leave it where the inner side alone is cut.
TEST(RefineSpace, noTetrahedronTurnsOver) {
  TetrahedronMesh mesh = cuboidMesh({{0, 0, 0}, {1, 1, 1}, {5, 1, 5}});
  for (SpacePoint& v : mesh.vertices) {
    const double angle = M_PI * v.x();
    const double radius = 1 + 0.02 * v.y();
    v = {-radius * std::cos(angle), radius * std::sin(angle), 0.05 * v.z()};
  }
  validate(mesh);
  CurvedFaces curves = curvesBehind(mesh);
  std::mt19937 random(3);
  int offCurve = 0;
  for (int round = 0; round < 12; ++round) {
    RefinedTetrahedra next = bisect(mesh, curves, randomMarks(mesh, random));
    mesh = std::move(next.mesh);
    curves = std::move(next.curves);
    offCurve += static_cast<int>(next.offCurve.size());
    expectSound(mesh);
  }
  EXPECT_GT(offCurve, 0);
}

/// After rounds of random marks; the largest distance of vertices from a label's surface.
template <class Distance>
double offAfterRounds(TetrahedronMesh mesh, int label, const Distance& distance) {
  putOntoGeometry(mesh);
  CurvedFaces curves = curvesBehind(mesh);
  std::mt19937 random(5);
  for (int round = 0; round < 8; ++round) {
    const std::vector<char> marks =
        round < 3 ? std::vector<char>(mesh.tetrahedra.size(), 1) : randomMarks(mesh, random);
    RefinedTetrahedra next = bisect(mesh, curves, marks);
    EXPECT_TRUE(next.offCurve.empty());
    mesh = std::move(next.mesh);
    curves = std::move(next.curves);
    for (size_t i = 0; i < mesh.boundaryTriangles.size(); ++i)
      for (size_t k = 0; k < 3 && mesh.boundaryLabels[i] == label; ++k)
        EXPECT_NEAR(mesh.boundaryNormals[i][k].norm(), 1, 1e-14) << "new vertices have normals";
  }
  expectSound(mesh);
  double most = 0;
  for (const int v : verticesOn(mesh, label)) most = std::max(most, std::abs(distance(mesh.vertices[v])));
  return most;
}

// Labels end at planes and at each other, and first meshes are coarse.
TEST(RefineSpace, verticesOfShapesLieOnThem) {
  const SpacePoint centre(1, 2, 3);
  for (const std::array<int, 3>& keep : {std::array<int, 3>{0, 0, 0}, std::array<int, 3>{1, 1, -1}}) {
    const auto ofBall = [&](const SpacePoint& x) { return (x - centre).norm() - 2; };
    EXPECT_LE(offAfterRounds(roundMesh({true, centre, 2, 1, keep, {2, 1}}), 7, ofBall), 1e-14);
    const auto ofCylinder = [&](const SpacePoint& x) { return (x - centre).head<2>().norm() - 2; };
    EXPECT_LE(offAfterRounds(roundMesh({false, centre, 2, 3, {keep[0], keep[1], 0}, {2, 2}}), 7, ofCylinder),
              1e-14);
  }
}

TEST(RefineSpace, verticesOfSweptCurvesLieOnTheirSurfaces) {
  MeshShape ring{Annulus{{0, 0}, 1, 2, 1, 3, 1}};
  const auto inner = [](const SpacePoint& x) { return x.head<2>().norm() - 1; };
  EXPECT_LE(offAfterRounds(sweptMesh(shapeMesh(ring), {1, 0, 2}), 1, inner), 1e-14);
  ring = MeshShape{Annulus{{3, 0}, 0.5, 1, 4, 8, 1}};  // a hollow torus, half of it
  const auto torus = [](const SpacePoint& x) { return std::hypot(std::hypot(x.x(), x.z()) - 3, x.y()) - 1; };
  EXPECT_LE(offAfterRounds(sweptMesh(shapeMesh(ring), {0, M_PI, 9}), 2, torus), 1e-13);
}

// Two cylinders that cross each other at any angle, and one beside a plane that touches it.
TEST(RefineSpace, pointsOfTwoSurfacesAreOnBoth) {
  struct Cylinders : GeometrySurfaces {
    [[nodiscard]] std::vector<std::optional<SurfaceFoot>> feet(
        const std::vector<std::pair<int, SpacePoint>>& points) const override {
      std::vector<std::optional<SurfaceFoot>> result;
      for (const auto& [surface, x] : points) {
        SpacePoint n = x;
        n[surface] = 0;
        n.normalize();
        SpacePoint at = (surface == 0 ? 0.6 : 1) * n;
        at[surface] = x[surface];
        at[surface] += 1e-3 * (x - at).norm();  // nearest but for a part of the way
        if (surface == 1) at = {x.x(), x.y(), 0.6};
        if (surface == 1) n = {0, 0, 1};
        result.emplace_back(SurfaceFoot{at, n});
      }
      return result;
    }
    [[nodiscard]] std::optional<SpacePoint> onSharedCurve(int, int, const SpacePoint& x) const override {
      return touches ? std::optional(SpacePoint(x.x(), 0, 0.6)) : std::nullopt;
    }
    [[nodiscard]] bool isPlane(int surface) const override { return surface == 1; }
    bool touches = false;
  };
  Cylinders geometry;  // 0 along x with radius 0.6, 2 along z with radius 1, 1 the plane z = 0.6
  const std::optional<SharedPoint> crossed = sharedPoint(geometry, {0, 2}, {0.9, 0.5, 0.4});
  ASSERT_TRUE(crossed);
  EXPECT_LE(crossed->off, 1e-15);
  EXPECT_NEAR(crossed->at.head<2>().norm(), 1, 1e-15);
  EXPECT_NEAR(crossed->at.tail<2>().norm(), 0.6, 1e-15);
  geometry.touches = true;
  const std::optional<SharedPoint> touching = sharedPoint(geometry, {0, 1}, {0.3, 0.02, 0.61});
  ASSERT_TRUE(touching);
  EXPECT_LE(touching->off, 1e-15);
}

TEST(RefineSpace, arcsAreExactAndSharpTurnsStraight) {
  for (const double half : {0.1, 0.5, 1.0}) {
    const SpacePoint d(2 * std::sin(half), 0, 0);
    const SpacePoint sagitta =
        sagittaOf(d, {std::cos(half), 0, std::sin(half)}, {std::cos(half), 0, -std::sin(half)});
    EXPECT_LE((sagitta - SpacePoint(0, 0, 1 - std::cos(half))).norm(), 1e-15);
  }
  EXPECT_EQ(sagittaOf({1, 0, 0}, {0.1, 0, 0.99}, {1, 0, 0}), SpacePoint::Zero());
}

}  // namespace mortier::refine_space_test
