// The quadratic triangle in a body: strains, forces, tangent and loads fit each other, whatever holds it.
#include <gtest/gtest.h>

#include <numbers>
#include <random>

#include "base/error.h"
#include "fem/body.h"
#include "fem/rigid_modes.h"
#include "material/perzyna.h"
#include "material/stress.h"
#include "mesh/generate.h"
#include "unit/dense_reference.h"

namespace mortier::quadratic_body_test {

constexpr int quadratic = 2;

TriangleMesh mesh(bool curved = false) {
  TriangleMesh mesh = rectangleMesh({.upper = {2, 1}, .cellsX = 4, .cellsY = 3}, Cut::both);
  std::mt19937 random(1);
  std::uniform_real_distribution<double> shift(-0.05, 0.05);
  for (Point& x : mesh.vertices)
    if (x.x() != 0 && x.x() != 2 && x.y() != 0 && x.y() != 1) x += Point(shift(random), shift(random));
  validate(mesh);
  if (curved)
    for (const auto& [a, b] : mesh.boundaryEdges) {
      const Point along = mesh.vertices[b] - mesh.vertices[a];
      mesh.edgeMiddles.emplace_back((mesh.vertices[a] + mesh.vertices[b]) / 2 +
                                    Point(along.y(), -along.x()) * 0.05);
    }
  return mesh;
}

Body body(Conditions conditions = {}, Projection projection = Projection::elasticity, bool curved = false) {
  return {"plate", mesh(curved), perzynaMaterial({100, 0.3}, {10, 1, projection}), std::move(conditions),
          quadratic};
}

Vector field(const Body& body, const std::function<Point(const Point&)>& u) {
  Vector result(body.dofs());
  for (int v = 0; v < body.nodes(); ++v) result.segment<2>(2 * v) = u(body.elementNodes().places[v]);
  return result;
}

Matrix strainOf(const Body& body, const Vector& u) {
  Matrix strain(3, body.points());
  body.strain({u, Vector::Zero(u.size())}, nullptr, strain, 0, body.points());
  return strain;
}

Function constant(double value) {
  return [value](double, double, double) { return value; };
}

TEST(QuadraticBody, nodesAreVerticesAndMiddles) {
  const Body plate = body();
  const auto vertices = static_cast<int>(plate.mesh().vertices.size());
  const auto triangles = static_cast<int>(plate.mesh().triangles.size());
  // Euler: edges = vertices + triangles - 1.
  EXPECT_EQ(plate.nodes(), vertices + (vertices + triangles - 1));
  EXPECT_EQ(plate.points(), 3 * triangles);
  double area = 0;
  for (const double weight : plate.weights()) area += weight;
  EXPECT_NEAR(area, 2, 1e-14);
}

TEST(QuadraticBody, strainOfAQuadraticDisplacementIsExact) {
  const Body plate = body();
  const Vector u = field(plate, [](const Point& x) {
    return Point(x.x() * x.x() - 3 * x.x() * x.y(), 2 * x.y() * x.y() + x.x() * x.y() - x.x());
  });
  const Matrix strain = strainOf(plate, u);
  const std::vector<Point> places = plate.places();
  for (int i = 0; i < plate.points(); ++i) {
    const auto& [x, y] = std::pair(places[i].x(), places[i].y());
    const Eigen::Vector3d expected = fromCartesian({2 * x - 3 * y, 4 * y + x, (-3 * x + y - 1) / 2});
    EXPECT_LE((strain.col(i) - expected).norm(), 1e-13);
  }
}

TEST(QuadraticBody, rigidMotionsStrainNothingAlsoWithCurvedSides) {
  const Body plate = body({}, Projection::elasticity, true);
  const Matrix modes = rigidModes(plate);
  ASSERT_EQ(modes.cols(), 3);
  for (int k = 0; k < 3; ++k) EXPECT_LE(strainOf(plate, modes.col(k)).cwiseAbs().maxCoeff(), 1e-13);
}

TEST(QuadraticBody, internalForceIsTheTransposeOfStrain) {
  std::mt19937 random(2);
  std::normal_distribution<double> normal;
  for (const bool curved : {false, true}) {
    const Body plate = body({}, Projection::elasticity, curved);
    const Vector u = Vector::NullaryExpr(plate.dofs(), [&] { return normal(random); });
    const Matrix stress = Matrix::NullaryExpr(3, plate.points(), [&] { return normal(random); });
    const Matrix strain = strainOf(plate, u);
    double work = 0;
    for (int i = 0; i < plate.points(); ++i) work += plate.weights()[i] * stress.col(i).dot(strain.col(i));
    EXPECT_NEAR(plate.internalForce(stress).dot(u), work, 1e-11);
  }
}

// K d is the internal force of the moduli times the strain of d, along free motions; both factorisations'
// patterns, with supports along axes and along slopes.
TEST(QuadraticBody, tangentIsThatOfTheInternalForce) {
  std::mt19937 random(3);
  std::normal_distribution<double> normal;
  for (const Projection projection : {Projection::elasticity, Projection::frobenius})
    for (const bool curved : {false, true}) {
      const Body plate = body(
          {{{1, alongNormal, constant(0)}, {4, alongX, constant(0)}, {2, alongTangent, constant(0)}}, {}, {}},
          projection, curved);
      const Matrix stress = 2 * Matrix::NullaryExpr(3, plate.points(), [&] { return normal(random); });
      const Matrix zero = Matrix::Zero(3, plate.points());
      Linearisation law = plate.material().room(plate.points());
      plate.material().linearise({0.1, zero, zero}, stress, law, 0, plate.points());
      std::vector<double> values;
      plate.tangent(law.moduli, values);
      const Matrix K = denseOf(plate.pattern(), values);
      const Vector x = Vector::NullaryExpr(K.rows(), [&] { return normal(random); });
      Matrix change = zero;
      plate.addStressOf(plate.spread(x), law, change, 0, plate.points());
      const Vector force = plate.gather(plate.internalForce(change));
      EXPECT_LE((K * x - force).lpNorm<Eigen::Infinity>(), 1e-12 * force.lpNorm<Eigen::Infinity>());
      const Matrix strain = strainOf(plate, plate.spread(x));
      for (int i = 0; i < plate.points(); ++i)
        ASSERT_LE((stressOf(law, strain.col(i), i) - change.col(i)).norm(), 1e-12 * change.norm());
    }
}

// Their work on polynomials of degree 2 is the integral.
TEST(QuadraticBody, loadsOfDegreeTwoAreExact) {
  const Function f = [](double x, double y, double t) { return t * (x * x + x * y + 1); };
  const Body plate = body({{}, {{2, alongX, f}}, {{1, f}}});
  const Vector u = field(plate, [](const Point& x) { return Point(x.y() * x.y(), x.x() * x.y()); });
  // Side x = 2: int (5 + 2 y) y^2; inside: int int (x^2 + x y + 1) x y over 2 x 1.
  const double side = 5.0 / 3 + 2.0 / 4;
  const double inside = 4.0 * 1 / 2 + 8.0 / 3 * 1 / 3 + 2.0 * 1 / 2;
  EXPECT_NEAR(plate.load(2).dot(u), 2 * (side + inside), 1e-12);
}

TEST(QuadraticBody, pressureOnAClosedCurveHasNoResultant) {
  Conditions conditions;
  for (const int label : {1, 2, 3, 4}) conditions.tractions.push_back({label, alongNormal, constant(-3)});
  const Vector load = body(conditions, Projection::elasticity, true).load(0);
  EXPECT_NEAR(Eigen::Map<const Eigen::Matrix2Xd>(load.data(), 2, load.size() / 2).rowwise().sum().norm(), 0,
              1e-13);
  EXPECT_GT(load.norm(), 1);
}

TEST(QuadraticBody, initialStressIsTakenAtThePoints) {
  Conditions conditions;
  conditions.initialStresses.push_back(
      {0, std::nullopt, [](double x, double y, double) { return x - 2 * y; }});
  const Body plate = body(conditions);
  const Matrix stress = plate.initialStress();
  for (int i = 0; i < plate.points(); ++i) {
    const Point x = plate.places()[i];
    ASSERT_NEAR(toCartesian(stress.col(i))[0], x.x() - 2 * x.y(), 1e-14);
  }
}

// On a polygon of a circle the normal at a vertex and at the middle of a side are those of the circle.
TEST(QuadraticBody, normalsOnCirclesAreExactAtMiddlesToo) {
  for (const bool curved : {false, true}) {
    TriangleMesh ring = annulusMesh({.cellsAround = 24, .cellsAcross = 2}, Cut::both);
    if (curved)
      for (const auto& [a, b] : ring.boundaryEdges) {
        const Point middle = (ring.vertices[a] + ring.vertices[b]) / 2;
        ring.edgeMiddles.emplace_back(middle * (ring.vertices[a].norm() / middle.norm()));
      }
    const Body body("ring", std::move(ring), elasticMaterial({1, 0.3}),
                    {{{2, alongNormal, constant(0)}}, {}, {}}, quadratic);
    ASSERT_EQ(body.supports().nodes().size(), 48);
    for (const NodeSupport& support : body.supports().nodes()) {
      const Point& x = body.elementNodes().places[support.node];
      EXPECT_LE((support.directions[0].head<2>() - x.normalized()).norm(), 1e-13);
    }
  }
}

TEST(QuadraticBody, aSideThatTurnsATriangleInsideOutIsRefused) {
  TriangleMesh broken = mesh(true);
  const auto& [a, b] = broken.boundaryEdges[0];
  const Point along = broken.vertices[b] - broken.vertices[a];
  broken.edgeMiddles[0] += 2 * Point(-along.y(), along.x());
  EXPECT_THROW(Body("plate", broken, elasticMaterial({1, 0.3}), {}, quadratic), InputError);
}

}  // namespace mortier::quadratic_body_test
