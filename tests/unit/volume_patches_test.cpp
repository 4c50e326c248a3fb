// The averaged volumetric strain: patches, what it reproduces, forces and tangent that fit it.
#include "fem/tangent_assembly.h"

#include <gtest/gtest.h>

#include <map>
#include <numbers>
#include <random>
#include <set>

#include "fem/body.h"
#include "fem/rigid_modes.h"
#include "material/deviatoric.h"
#include "mesh/generate.h"
#include "unit/dense_reference.h"

namespace mortier::volume_patches_test {

constexpr double root2 = std::numbers::sqrt2;

TriangleMesh mesh(Cut cut = Cut::rising) {
  TriangleMesh mesh = rectangleMesh({.lower = {1, 0}, .upper = {3, 1}, .cellsX = 7, .cellsY = 5}, cut);
  std::mt19937 random(1);
  std::uniform_real_distribution<double> shift(-0.04, 0.04);
  for (Point& x : mesh.vertices)
    if (x.x() != 1 && x.x() != 3 && x.y() != 0 && x.y() != 1) x += Point(shift(random), shift(random));
  return mesh;
}

Function constant(double value) {
  return [value](double, double, double) { return value; };
}

struct Kind {
  int degree;
  bool aboutAxis;
};
constexpr Kind kinds[] = {{1, false}, {2, false}, {1, true}, {2, true}};

Body body(const Kind& kind, Conditions conditions = {}, bool averaged = true) {
  return {"plate",
          mesh(),
          elasticMaterial({3, 0.4999}, Plane::strain),
          std::move(conditions),
          kind.degree,
          kind.aboutAxis,
          averaged};
}

Matrix strainOf(const Body& body, const Vector& u) {
  Matrix strain(body.material().components(), body.points());
  body.strain({u, Vector::Zero(u.size())}, nullptr, strain, 0, body.points());
  return strain;
}

Vector field(const Body& body, const std::function<Point(const Point&)>& u) {
  Vector result(body.dofs());
  for (int v = 0; v < body.nodes(); ++v) result.segment<2>(2 * v) = u(body.elementNodes().places[v]);
  return result;
}

/// root2 p, and the circumference.
Vector volume(const Body& body, const Matrix& strain) {
  Vector theta = root2 * strain.row(0);
  if (body.axisymmetric()) theta += strain.row(3).transpose();
  return theta;
}

TEST(VolumePatches, areConnectedOfOneRegionAndFewTriangles) {
  for (const Cut cut : {Cut::rising, Cut::falling, Cut::both})
    for (const int degree : {1, 2}) {
      TriangleMesh parts = mesh(cut);
      for (size_t t = 0; t < parts.triangles.size(); ++t)
        parts.regions[t] = parts.vertices[parts.triangles[t][0]].x() < 1.9 ? 1 : 2;
      const std::vector<int> patchOf = volumePatches(parts, degree);
      std::map<int, std::vector<int>> patches;
      for (size_t t = 0; t < patchOf.size(); ++t) patches[patchOf[t]].push_back(static_cast<int>(t));
      EXPECT_EQ(patches.rbegin()->first + 1, static_cast<int>(patches.size()));
      for (const auto& [patch, triangles] : patches) {
        EXPECT_GE(triangles.size(), degree == 1 ? 3 : 2);
        EXPECT_LE(triangles.size(), degree == 1 ? 8 : 4);
        std::set<int> reached{triangles[0]};
        for (size_t pass = 0; pass < triangles.size(); ++pass)
          for (const int t : triangles)
            for (const int other : std::set<int>(reached)) {
              int common = 0;
              for (const int v : parts.triangles[t])
                common += static_cast<int>(
                    std::count(parts.triangles[other].begin(), parts.triangles[other].end(), v));
              if (common >= 2) reached.insert(t);
            }
        EXPECT_EQ(reached.size(), triangles.size());
        for (const int t : triangles) EXPECT_EQ(parts.regions[t], parts.regions[triangles[0]]);
      }
    }
}

// Degree 1 constants, degree 2 linear functions; elsewhere the mean over a patch is kept and the change is
// one of p alone.
TEST(VolumePatches, polynomialsAreReproducedAndMeansKept) {
  std::mt19937 random(2);
  std::normal_distribution<double> normal;
  for (const Kind& kind : kinds) {
    const Body averaged = body(kind);
    const Body pointwise = body(kind, {}, false);
    const double curl = kind.degree - 1;
    const Vector u = field(averaged, [&](const Point& x) {
      const double inPlane = kind.aboutAxis ? 0 : 1;
      return Point(2 * x.x() + inPlane * x.y() + curl * x.x() * (3 * x.y() + inPlane * x.x()),
                   x.x() - x.y() * (4 - curl * x.y()));
    });
    EXPECT_LE((strainOf(averaged, u) - strainOf(pointwise, u)).cwiseAbs().maxCoeff(), 2e-13) << kind.degree;
    const Vector any = Vector::NullaryExpr(averaged.dofs(), [&] { return normal(random); });
    const Matrix strain = strainOf(averaged, any);
    const Matrix change = strain - strainOf(pointwise, any);
    EXPECT_LE(change.bottomRows(change.rows() - 1).cwiseAbs().maxCoeff(), 0);
    std::map<int, double> sums;
    const std::vector<int>& patchOf = averaged.patches()->patchOf();
    for (int i = 0; i < averaged.points(); ++i)
      sums[patchOf[i / averaged.pointsOfTriangle()]] += averaged.weights()[i] * change(0, i);
    EXPECT_GE(change.norm(), 0.1 * strain.norm());
    for (const auto& [patch, sum] : sums) EXPECT_LE(std::abs(sum), 1e-13);
    // A projection, and that of a field given at the points.
    const Vector theta = volume(averaged, strain);
    EXPECT_LE((averaged.patches()->averaged(theta, averaged.weights()) - theta).norm(), 1e-13 * theta.norm());
    const Vector before = volume(pointwise, strainOf(pointwise, any));
    EXPECT_LE((averaged.patches()->averaged(before, averaged.weights()) - theta).norm(),
              1e-12 * theta.norm());
  }
}

TEST(VolumePatches, rigidMotionsStrainNothing) {
  for (const Kind& kind : kinds) {
    const Body plate = body(kind);
    const Matrix modes = rigidModes(plate);
    ASSERT_EQ(modes.cols(), kind.aboutAxis ? 1 : 3);
    for (int k = 0; k < modes.cols(); ++k)
      EXPECT_LE(strainOf(plate, modes.col(k)).cwiseAbs().maxCoeff(), 1e-13);
  }
}

TEST(VolumePatches, forcesAndTangentAreThoseOfTheStrain) {
  std::mt19937 random(3);
  std::normal_distribution<double> normal;
  for (const Kind& kind : kinds) {
    std::vector<PrescribedDisplacement> turned{{1, alongNormal, constant(0)}, {4, alongX, constant(0)}};
    if (!kind.aboutAxis) turned.push_back({2, alongTangent, constant(0)});
    Body plate = body(kind, {turned, {}, {}});
    const Vector u = Vector::NullaryExpr(plate.dofs(), [&] { return normal(random); });
    const Matrix stress =
        Matrix::NullaryExpr(plate.material().components(), plate.points(), [&] { return normal(random); });
    const Matrix strain = strainOf(plate, u);
    const Eigen::Index rows = kind.aboutAxis ? 4 : 3;
    double work = 0;
    for (int i = 0; i < plate.points(); ++i)
      work += plate.weights()[i] * stress.col(i).head(rows).dot(strain.col(i).head(rows));
    EXPECT_NEAR(plate.internalForce(stress).dot(u), work, 1e-11 * std::abs(work));

    const Matrix zero = Matrix::Zero(stress.rows(), stress.cols());
    Linearisation law = plate.material().room(plate.points());
    plate.material().linearise({0.1, zero, zero}, zero, law, 0, plate.points());
    for (const int threads : {1, 3}) {
      Threads some(threads);
      std::vector<double> values;
      plate.tangent(law, values, some);
      const Matrix K = denseOf(plate.pattern(), values);
      const Vector x = Vector::NullaryExpr(K.rows(), [&] { return normal(random); });
      Matrix change = zero;
      plate.addStressOf(plate.spread(x), law, change, 0, plate.points());
      const Vector force = plate.gather(plate.internalForce(change));
      EXPECT_LE((K * x - force).lpNorm<Eigen::Infinity>(), 1e-12 * force.lpNorm<Eigen::Infinity>());
      const Matrix of = strainOf(plate, plate.spread(x));
      for (int i = 0; i < plate.points(); ++i)
        ASSERT_LE((stressOf(law, of.col(i), i).head(rows) - change.col(i).head(rows)).norm(),
                  1e-12 * change.norm());
    }
  }
}

}  // namespace mortier::volume_patches_test
