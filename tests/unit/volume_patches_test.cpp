// The averaged volumetric strain: patches, what it reproduces, forces and tangent that fit it.
#include "fem/volume_patches.h"

#include <gtest/gtest.h>

#include <Eigen/Geometry>

#include <map>
#include <numbers>
#include <random>
#include <set>

#include "fem/body.h"
#include "fem/rigid_modes.h"
#include "material/deviatoric.h"
#include "material/perzyna.h"
#include "mesh/generate.h"
#include "mesh/shape.h"
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

/// None of its sides is across an axis.
TetrahedronMesh spaceMesh() {
  TetrahedronMesh mesh = cuboidMesh({{0, 0, 0}, {1, 1.5, 1}, {4, 5, 3}});
  const Eigen::Matrix3d turn = Eigen::Quaterniond(0.8, 0.2, -0.4, 0.4).normalized().toRotationMatrix();
  std::mt19937 random(1);
  std::uniform_real_distribution<double> shift(-0.04, 0.04);
  for (SpacePoint& x : mesh.vertices) {
    const bool inside = x.x() > 0 && x.x() < 1 && x.y() > 0 && x.y() < 1.5 && x.z() > 0 && x.z() < 1;
    if (inside) x += SpacePoint(shift(random), shift(random), shift(random));
    x = (turn * x).eval();
  }
  return mesh;
}

struct Kind {
  int degree;
  Plane plane;  ///< none: in space
  [[nodiscard]] bool aboutAxis() const { return plane == Plane::axisymmetric; }
  [[nodiscard]] bool inSpace() const { return plane == Plane::none; }
  /// Of the strain that is averaged: its component, and how many components act.
  [[nodiscard]] int component() const { return inSpace() ? 5 : 0; }
  [[nodiscard]] int rows() const { return inSpace() ? 6 : aboutAxis() ? 4 : 3; }
};
constexpr Kind kinds[] = {{1, Plane::strain},
                          {2, Plane::strain},
                          {1, Plane::axisymmetric},
                          {2, Plane::axisymmetric},
                          {1, Plane::none}};

struct BodyConditions {
  Conditions plane = {};
  Conditions space = {};
};

Body body(const Kind& kind, bool averaged = true, BodyConditions conditions = {},
          std::shared_ptr<const Material> material = nullptr) {
  if (!material) material = elasticMaterial({3, 0.4999}, kind.inSpace() ? kind.plane : Plane::strain);
  if (kind.inSpace())
    return {"block", spaceMesh(), std::move(material), std::move(conditions.space), 1, averaged};
  return {"plate",          mesh(),  std::move(material), std::move(conditions.plane), kind.degree,
          kind.aboutAxis(), averaged};
}

/// Supports, some of them across the axes.
BodyConditions held(const Kind& kind) {
  std::vector<Condition> turned{{1, alongNormal, constant(0)}, {4, alongX, constant(0)}};
  if (!kind.aboutAxis()) turned.push_back({2, alongTangent, constant(0)});
  const Datum zero = [](const SpacePoint&, double) { return 0.0; };
  return {{turned, {}, {}}, {{{1, alongNormal, zero}, {2, alongNormal, zero}, {4, alongX, zero}}, {}}};
}

Matrix strainOf(const Body& body, const Vector& u) {
  Matrix strain(body.material().components(), body.points());
  body.strain({u, Vector::Zero(u.size())}, nullptr, strain, 0, body.points());
  return strain;
}

Vector field(const Body& body, const std::function<SpacePoint(const SpacePoint&)>& u) {
  Vector result(body.dofs());
  const int d = body.dimension();
  for (int v = 0; v < body.nodes(); ++v) result.segment(d * v, d) = u(body.placeOfNode(v)).head(d);
  return result;
}

/// The change of volume: root2 p, and the circumference; in space root3 p.
Vector volume(const Kind& kind, const Matrix& strain) {
  Vector theta = std::sqrt(kind.inSpace() ? 3 : 2) * strain.row(kind.component());
  if (kind.aboutAxis()) theta += strain.row(3).transpose();
  return theta;
}

/// Whether elements with `common` vertices in common, one by one, lead to all elements of a patch.
template <class Elements>
bool connected(const std::vector<int>& patch, const Elements& elements, int common) {
  std::set<int> reached{patch[0]};
  for (size_t pass = 0; pass < patch.size(); ++pass)
    for (const int e : patch)
      for (const int other : std::set<int>(reached)) {
        int shared = 0;
        for (const int v : elements[e])
          shared += static_cast<int>(std::count(elements[other].begin(), elements[other].end(), v));
        if (shared >= common) reached.insert(e);
      }
  return reached.size() == patch.size();
}

template <class Elements>
void expectPatches(const std::vector<int>& patchOf, const Elements& elements, const std::vector<int>& regions,
                   int common, size_t least, size_t most) {
  std::map<int, std::vector<int>> patches;
  for (size_t e = 0; e < patchOf.size(); ++e) patches[patchOf[e]].push_back(static_cast<int>(e));
  EXPECT_EQ(patches.rbegin()->first + 1, static_cast<int>(patches.size()));
  for (const auto& [patch, of] : patches) {
    EXPECT_GE(of.size(), least);
    EXPECT_LE(of.size(), most);
    EXPECT_TRUE(connected(of, elements, common));
    for (const int e : of) EXPECT_EQ(regions[e], regions[of[0]]);
  }
}

TEST(VolumePatches, areConnectedOfOneRegionAndFewElements) {
  for (const Cut cut : {Cut::rising, Cut::falling, Cut::both})
    for (const int degree : {1, 2}) {
      TriangleMesh parts = mesh(cut);
      for (size_t t = 0; t < parts.triangles.size(); ++t)
        parts.regions[t] = parts.vertices[parts.triangles[t][0]].x() < 1.9 ? 1 : 2;
      expectPatches(volumePatches(parts, degree), parts.triangles, parts.regions, 2, degree == 1 ? 3 : 2,
                    degree == 1 ? 8 : 4);
    }
  TetrahedronMesh parts = spaceMesh();
  for (size_t t = 0; t < parts.tetrahedra.size(); ++t) parts.regions[t] = t < 150 ? 1 : 2;
  expectPatches(volumePatches(parts), parts.tetrahedra, parts.regions, 3, 12, 32);
}

// Degree 1 constants, degree 2 linear functions; elsewhere the mean over a patch is kept and the change is
// one of p alone.
TEST(VolumePatches, polynomialsAreReproducedAndMeansKept) {
  std::mt19937 random(2);
  std::normal_distribution<double> normal;
  for (const Kind& kind : kinds) {
    const Body averaged = body(kind);
    const Body pointwise = body(kind, false);
    const double curl = kind.degree - 1;
    const Vector u = field(averaged, [&](const SpacePoint& x) {
      const double inPlane = kind.aboutAxis() ? 0 : 1;
      return SpacePoint(2 * x.x() + inPlane * x.y() + curl * x.x() * (3 * x.y() + inPlane * x.x()),
                        x.x() - x.y() * (4 - curl * x.y()) + 2 * x.z(), x.y() - 7 * x.z());
    });
    EXPECT_LE((strainOf(averaged, u) - strainOf(pointwise, u)).cwiseAbs().maxCoeff(), 2e-13) << kind.degree;
    const Vector any = Vector::NullaryExpr(averaged.dofs(), [&] { return normal(random); });
    const Matrix strain = strainOf(averaged, any);
    Matrix change = strain - strainOf(pointwise, any);
    std::map<int, double> sums;
    const std::vector<int>& patchOf = averaged.patches()->patchOf();
    for (int i = 0; i < averaged.points(); ++i)
      sums[patchOf[i / averaged.pointsOfTriangle()]] += averaged.weights()[i] * change(kind.component(), i);
    EXPECT_GE(change.row(kind.component()).norm(), 0.1 * strain.norm());
    change.row(kind.component()).setZero();
    EXPECT_LE(change.cwiseAbs().maxCoeff(), 0);
    for (const auto& [patch, sum] : sums) EXPECT_LE(std::abs(sum), 1e-13);
    // A projection, and that of a field given at the points.
    const Vector theta = volume(kind, strain);
    EXPECT_LE((averaged.patches()->averaged(theta, averaged.weights()) - theta).norm(), 1e-13 * theta.norm());
    const Vector before = volume(kind, strainOf(pointwise, any));
    EXPECT_LE((averaged.patches()->averaged(before, averaged.weights()) - theta).norm(),
              1e-12 * theta.norm());
  }
}

TEST(VolumePatches, rigidMotionsStrainNothing) {
  for (const Kind& kind : kinds) {
    const Body plate = body(kind);
    const Matrix modes = rigidModes(plate);
    ASSERT_EQ(modes.cols(), kind.inSpace() ? 6 : kind.aboutAxis() ? 1 : 3);
    for (int k = 0; k < modes.cols(); ++k)
      EXPECT_LE(strainOf(plate, modes.col(k)).cwiseAbs().maxCoeff(), 1e-13);
  }
}

TEST(VolumePatches, forcesAndTangentAreThoseOfTheStrain) {
  std::mt19937 random(3);
  std::normal_distribution<double> normal;
  for (const Kind& kind : kinds) {
    const Body plate = body(kind, true, held(kind));
    const Vector u = Vector::NullaryExpr(plate.dofs(), [&] { return normal(random); });
    const Matrix stress =
        Matrix::NullaryExpr(plate.material().components(), plate.points(), [&] { return normal(random); });
    const Matrix strain = strainOf(plate, u);
    const Eigen::Index rows = kind.rows();
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

// Of bodies that flow: the tangent is the derivative of the nodal forces by the displacements.
TEST(VolumePatches, tangentOfFlowIsTheDerivativeOfTheForces) {
  std::mt19937 random(4);
  std::normal_distribution<double> normal;
  constexpr double step = 1e-6;
  for (const Kind& kind : kinds) {
    const Plane plane = kind.plane;
    const Body plate = body(kind, true, held(kind), perzynaMaterial({3, 0.3}, {1e-2, 1}, plane));
    const Matrix zero = Matrix::Zero(plate.material().components(), plate.points());
    Linearisation law = plate.material().room(plate.points());
    const auto forces = [&](const Vector& x) {
      // At the stress to which the strain leads: in the plane after some iterations.
      Matrix stress = zero;
      for (int k = 0; k < 60; ++k) {
        plate.material().linearise({1, zero, strainOf(plate, plate.spread(x))}, stress, law, 0,
                                   plate.points());
        stress = law.predictor;
      }
      return plate.gather(plate.internalForce(stress));
    };
    const Vector x = Vector::NullaryExpr(plate.freeDofs(), [&] { return normal(random); });
    const Vector along = Vector::NullaryExpr(plate.freeDofs(), [&] { return normal(random); });
    const Vector change = (forces(x + step * along) - forces(x - step * along)) / (2 * step);
    forces(x);
    std::vector<double> values;
    plate.tangent(law, values);
    EXPECT_LE((denseOf(plate.pattern(), values) * along - change).norm(), 1e-5 * change.norm())
        << kind.degree
        << (kind.inSpace()     ? ", in space"
            : kind.aboutAxis() ? ", about an axis"
                               : "");
  }
}

}  // namespace mortier::volume_patches_test
