#include "fem/supports.h"

#include <gtest/gtest.h>

#include <Eigen/Geometry>

#include <cmath>
#include <random>

#include "fem/rigid_modes.h"
#include "mesh/generate.h"
#include "unit/dense_reference.h"
#include "unit/plate.h"

namespace mortier::supports_test {

using namespace plate;

/// The plate turned by an angle about the origin.
TriangleMesh turnedPlate(double angle) {
  TriangleMesh mesh = plateMesh();
  const Eigen::Rotation2Dd turn(angle);
  for (Point& x : mesh.vertices) x = turn * x;
  return mesh;
}

/// A ring of radii 1 and 2, its nodes anywhere along the circles; labels 1 inside, 2 outside.
TriangleMesh ring(int around, std::mt19937& random) {
  std::uniform_real_distribution<double> shift(-0.3, 0.3);
  TriangleMesh mesh;
  mesh.name = "ring";
  for (const double radius : {1.0, 2.0})
    for (int i = 0; i < around; ++i) {
      const double angle = 2 * M_PI * (i + shift(random)) / around;
      mesh.vertices.emplace_back(radius * std::cos(angle), radius * std::sin(angle));
    }
  for (int i = 0; i < around; ++i) {
    const int next = (i + 1) % around;
    mesh.triangles.push_back({i, around + i, around + next});
    mesh.triangles.push_back({i, around + next, next});
    mesh.boundaryEdges.push_back({i, next});
    mesh.boundaryLabels.push_back(1);
    mesh.boundaryEdges.push_back({around + i, around + next});
    mesh.boundaryLabels.push_back(2);
  }
  mesh.regions.assign(mesh.triangles.size(), 1);
  validate(mesh);
  return mesh;
}

Body bodyOf(TriangleMesh mesh, std::vector<Condition> supports) {
  return {"body",
          std::move(mesh),
          perzynaMaterial({100, 0.3}, {10, 1, Projection::elasticity}),
          {std::move(supports), {}, {}}};
}

TEST(Supports, normalsOfCirclesAreExactWhateverTheSpacing) {
  constexpr double rounding = 1e-14;
  std::mt19937 random(1);
  const TriangleMesh mesh = ring(24, random);
  const Supports supports(mesh, {{1, alongNormal, constant(0)}, {2, alongTangent, constant(0)}});
  ASSERT_EQ(supports.nodes().size(), mesh.vertices.size());
  EXPECT_TRUE(supports.further().empty());
  for (const NodeSupport& support : supports.nodes()) {
    ASSERT_EQ(support.count, 1);
    const Point r = mesh.vertices[support.node].normalized();
    // Outward is inward on the inner circle; the body is to the left of the tangent.
    const Point expected = support.node < 24 ? Point(-r) : Point(-r.y(), r.x());
    EXPECT_LE((support.directions[0].head<2>() - expected).norm(), rounding);
  }
}

TEST(Supports, endsOfArcsAreOnTheCircleToo) {
  constexpr double rounding = 1e-14;
  std::mt19937 random(2);
  TriangleMesh mesh = ring(24, random);
  for (size_t e = 0; e < mesh.boundaryEdges.size(); ++e) {
    const Point middle =
        (mesh.vertices[mesh.boundaryEdges[e][0]] + mesh.vertices[mesh.boundaryEdges[e][1]]) / 2;
    if (mesh.boundaryLabels[e] == 2 && middle.y() > 0.5) mesh.boundaryLabels[e] = middle.x() > 0 ? 3 : 4;
  }
  for (const std::vector<int>& labels : {std::vector<int>{3}, {3, 4}}) {
    std::vector<Condition> conditions;
    for (const int label : labels) conditions.push_back({label, alongNormal, constant(0)});
    const Supports supports(mesh, conditions);
    EXPECT_EQ(supports.further().size(), labels.size() - 1);  // the node where both meet
    for (const NodeSupport& support : supports.nodes()) {
      ASSERT_EQ(support.count, 1);
      EXPECT_LE((support.directions[0].head<2>() - mesh.vertices[support.node].normalized()).norm(),
                rounding);
    }
  }
}

TEST(Supports, cornersAreHeldAndObeyBothConditions) {
  constexpr double rounding = 1e-14;
  const double angle = 0.4;
  const TriangleMesh mesh = turnedPlate(angle);
  const Body plate =
      bodyOf(mesh, {{left, alongNormal, constant(0.3)}, {bottom, alongNormal, constant(-0.2)}});
  Vector u = Vector::Constant(plate.dofs(), 7);
  plate.prescribe(0, u);
  const Eigen::Rotation2Dd turn(angle);
  int held = 0;
  for (const NodeSupport& support : plate.supports().nodes()) {
    const Point local = turn.inverse() * mesh.vertices[support.node];
    const Point moved = turn.inverse() * Point(u.segment<2>(2 * support.node));
    const Point free = turn.inverse() * Point(7, 7);
    const bool onLeft = std::abs(local.x()) < 1e-9;
    const bool onBottom = std::abs(local.y()) < 1e-9;
    EXPECT_NEAR(moved.x(), onLeft ? -0.3 : free.x(), rounding);
    EXPECT_NEAR(moved.y(), onBottom ? 0.2 : free.y(), rounding);
    EXPECT_EQ(support.count, onLeft && onBottom ? 2 : 1);
    held += support.count;
  }
  EXPECT_EQ(plate.freeDofs(), plate.dofs() - held);
}

TEST(Supports, aFurtherConditionSaysWhatTheOthersImply) {
  const TriangleMesh mesh = plateMesh();
  const Supports supports(mesh, {{left, alongX, constant(0.5)},
                                 {left, alongY, constant(0)},
                                 {bottom, alongNormal, constant(0)},
                                 {bottom, alongTangent, constant(0.5)}});
  ASSERT_EQ(supports.further().size(), 2u);
  for (const FurtherMotion& motion : supports.further()) {
    const NodeSupport& support = supports.nodes()[motion.support];
    EXPECT_EQ(mesh.vertices[support.node], Point(0, 0));
    EXPECT_NEAR(support.implied({0.5, 0}, motion.direction), motion.condition == 2 ? 0 : 0.5, 1e-15);
  }
}

// Equations of turned nodes: K x = gather(internal force of spread x), and both maps are transposes.
TEST(Supports, tangentOfTurnedNodesIsThatOfTheBodyTurned) {
  std::mt19937 random(3);
  std::normal_distribution<double> normal;
  const auto vector = [&](int n) {
    return Vector(Vector::NullaryExpr(n, [&](Eigen::Index) { return normal(random); }));
  };
  for (const bool symmetric : {true, false}) {
    const Body plate(
        "plate", turnedPlate(0.7),
        perzynaMaterial({100, 0.3}, {10, 1, symmetric ? Projection::frobenius : Projection::elasticity}),
        {{{left, alongNormal, constant(0)}, {bottom, alongTangent, constant(0)}, {top, alongX, constant(0)}},
         {},
         {}});
    Matrix moduli = vector(9 * plate.points()).reshaped(9, plate.points());
    if (symmetric)
      for (Eigen::Index i = 0; i < moduli.cols(); ++i)
        for (const auto& [a, b] : {std::pair(1, 3), {2, 6}, {5, 7}}) moduli(a, i) = moduli(b, i);
    std::vector<double> values;
    plate.tangent(moduli, values);
    ASSERT_EQ(plate.pattern().symmetric, symmetric);
    const Vector x = vector(plate.freeDofs());
    const Vector Kx = denseOf(plate.pattern(), values) * x;
    Matrix stress = Matrix::Zero(3, plate.points());
    plate.addStressOf(plate.spread(x), {{}, moduli}, stress, 0, plate.points());
    const Vector expected = plate.gather(plate.internalForce(stress));
    EXPECT_LE((Kx - expected).cwiseAbs().maxCoeff(), 1e-13 * expected.cwiseAbs().maxCoeff());
    const Vector f = vector(plate.dofs());
    EXPECT_NEAR(plate.gather(f).dot(x), f.dot(plate.spread(x)), 1e-12);
    for (int v = 0; v < plate.nodes(); ++v)
      for (const auto& [equation, value] : plate.parts(v, Point(f.segment<2>(2 * v))))
        if (equation >= 0) {
          EXPECT_NEAR(value, plate.gather(f)[equation], 1e-15);
        }
  }
}

TEST(Supports, incrementsKeepWhatIsFree) {
  constexpr double rounding = 1e-15;
  const Body plate = bodyOf(
      turnedPlate(0.7),
      {{left, alongNormal, [](double, double, double t) { return 2 * t; }}, {right, alongX, constant(1)}});
  const Vector before = Vector::LinSpaced(plate.dofs(), 2, 3);
  TwoPartVector carried{before, Vector::Constant(plate.dofs(), 1e-17)};
  plate.prescribeIncrement(0.25, 0.5, carried);
  const auto& [increment, small] = carried;
  for (const NodeSupport& support : plate.supports().nodes()) {
    ASSERT_EQ(support.count, 1);
    const Point d = support.directions[0].head<2>();
    const Point t(-d.y(), d.x());
    const int dof = 2 * support.node;
    const bool moves = support.conditions[0] == 0;
    EXPECT_NEAR(d.dot(increment.segment<2>(dof)), moves ? 0.5 : 0, 4 * rounding);
    EXPECT_NEAR(t.dot((increment - before).segment<2>(dof)), 0, 4 * rounding);
    EXPECT_NEAR(d.dot(small.segment<2>(dof)), 0, 1e-32);
  }
}

// Half of all directions have a positive cross product with themselves where products are rounded once.
TEST(Supports, nodesOfAStraightSideHaveOneDirectionWhateverItsSlope) {
  constexpr double rounding = 1e-13;
  constexpr int slopes = 120;
  for (int i = 0; i < slopes; ++i) {
    const double angle = (i + 0.3) * 2 * M_PI / slopes;
    const Eigen::Rotation2Dd turn(angle);
    for (const int cells : {16, 20, 45})
      for (const Component component : {alongNormal, alongTangent}) {
        TriangleMesh mesh = rectangleMesh(Rectangle{{0, 0}, {2, 1}, cells, 2});
        for (Point& x : mesh.vertices) x = turn * x;
        const Supports supports(mesh, {{1, component, constant(0)}, {3, component, constant(0)}});
        ASSERT_EQ(supports.nodes().size(), 2 * (cells + 1u));
        EXPECT_TRUE(supports.further().empty());
        const Point expected = turn * (component == alongNormal ? Point(0, 1) : Point(1, 0));
        const Point first = supports.nodes()[0].directions[0].head<2>();
        EXPECT_LE(std::abs(cross(first, expected)), rounding) << angle;
        for (const NodeSupport& support : supports.nodes()) {
          ASSERT_EQ(support.count, 1);
          const Point d = support.directions[0].head<2>();
          EXPECT_TRUE(d == first || d == Point(-first)) << "slope " << angle << ", node " << support.node;
        }
      }
  }
}

// A curve of many nodes, whose directions are as many.
TEST(Supports, everyDirectionOfACurveIsFound) {
  constexpr double same = 1e-5;  // directions whose sine is below it have their mean
  std::mt19937 random(5);
  for (const int around : {17, 100, 1000}) {
    const TriangleMesh mesh = ring(around, random);
    const Supports supports(mesh, {{1, alongNormal, constant(0)}, {2, alongNormal, constant(0)}});
    ASSERT_EQ(supports.nodes().size(), mesh.vertices.size());
    for (const NodeSupport& support : supports.nodes()) {
      const Point r = mesh.vertices[support.node].normalized();
      EXPECT_LE(std::abs(cross(support.directions[0].head<2>(), r)), same) << support.node;
    }
  }
}

TEST(Supports, rollersLeaveTheMotionAlongThem) {
  const double angle = M_PI / 6;
  const Body slope = bodyOf(turnedPlate(angle), {{bottom, alongNormal, constant(0)}});
  Matrix modes = rigidModes(slope);
  ASSERT_EQ(modes.cols(), 1);
  const std::string words = describeRigidMotion(slope, modes.col(0));
  EXPECT_TRUE(words == "translation along (0.866, 0.5)" || words == "translation along (-0.866, -0.5)")
      << words;
  std::mt19937 random(4);
  const Body turning = bodyOf(ring(17, random), {{1, alongNormal, constant(0)}});
  modes = rigidModes(turning);
  ASSERT_EQ(modes.cols(), 1);
  EXPECT_NEAR(
      (turning.gather(modes.col(0)) - turning.gather(turning.spread(turning.gather(modes.col(0))))).norm(), 0,
      1e-15);
  // A rotation about the centre: velocities across the radii.
  for (int v = 0; v < turning.nodes(); ++v)
    EXPECT_NEAR(turning.mesh().vertices[v].dot(modes.col(0).segment<2>(2 * v)), 0, 1e-12);
  EXPECT_EQ(rigidModes(bodyOf(ring(17, random), {{1, alongTangent, constant(0)}})).cols(), 0);
}

}  // namespace mortier::supports_test
