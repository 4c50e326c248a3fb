// Rows between surfaces that follow the bodies (ContactInterface::follow).
#include <gtest/gtest.h>

#include <Eigen/Geometry>
#include <cmath>

#include "contact/interface.h"
#include "fem/body.h"
#include "material/elasticity.h"
#include "mesh/shape.h"

namespace mortier::follow_in_space_test {
namespace {

constexpr int bottom = 1;
constexpr int top = 3;
constexpr double rounding = 1e-13;  // of lengths of order one

struct Kind {
  CouplingKind coupling;
  int degree;
};
constexpr Kind all[] = {{CouplingKind::interpolation, 1},
                        {CouplingKind::mortar, 1},
                        {CouplingKind::weighted, 1},
                        {CouplingKind::weighted, 2}};

/// A block above a table that is wider; the block is nonmortar.
struct Blocks {
  TetrahedronMesh upper;
  TetrahedronMesh table = cuboidMesh({{-1, -1, -1}, {2, 2, 0}, {7, 6, 1}});
  SpaceNodes upperNodes, tableNodes;

  explicit Blocks(const SpacePoint& at, int degree)
      : upper(cuboidMesh({at, at + SpacePoint(1, 1, 1), {3, 4, 1}})),
        upperNodes(spaceNodes(upper, degree)),
        tableNodes(spaceNodes(table, degree)) {}

  [[nodiscard]] ContactInterface meet(CouplingKind kind, bool follows, double stiffness = 1) const {
    InterfaceOptions options;
    options.follows = follows;
    options.friction.coefficient = 0.3;
    options.stiffness = stiffness;
    return {{{0, bottom}, {1, top}, kind},
            SpaceContactMesh{upper, upperNodes},
            SpaceContactMesh{table, tableNodes},
            options};
  }
};

template <class F>
Vector field(const SpaceNodes& nodes, F u) {
  Vector result(3 * static_cast<Eigen::Index>(nodes.places.size()));
  for (size_t v = 0; v < nodes.places.size(); ++v)
    result.segment<3>(3 * static_cast<Eigen::Index>(v)) = u(nodes.places[v]);
  return result;
}

Vector still(const SpaceNodes& nodes) {
  return Vector::Zero(3 * static_cast<Eigen::Index>(nodes.places.size()));
}

TEST(FollowInSpace, rowsAreThoseOfBodiesMeshedThere) {
  const SpacePoint by(0.37, -0.21, 0.02);
  for (const auto& [kind, degree] : all) {
    const Blocks drawn({0, 0, 0}, degree);
    const Blocks there(by, degree);
    ContactInterface moved = drawn.meet(kind, true);
    const Vector u1 = field(drawn.upperNodes, [&](const SpacePoint&) { return by; });
    const Vector u2 = still(drawn.tableNodes);
    moved.follow(u1, u2);
    const ContactInterface meshed = there.meet(kind, false);
    ASSERT_EQ(moved.nonmortarNodes(), meshed.nonmortarNodes());
    const auto off = [](const ConstraintRows& a, const ConstraintRows& b) { return Matrix(a - b).norm(); };
    EXPECT_LE(off(moved.C1(), meshed.C1()), rounding);
    EXPECT_LE(off(moved.C2(), meshed.C2()), rounding);
    EXPECT_LE(off(moved.T1(), meshed.T1()), rounding);
    EXPECT_LE(off(moved.T2(), meshed.T2()), rounding);
    EXPECT_LE((moved.gap(u1, u2) + meshed.initialDistance()).lpNorm<Eigen::Infinity>(), rounding);
    EXPECT_NEAR(moved.interpenetration(u1, u2), 0, rounding);
  }
}

// Off the end rows are empty, and those within it are those of the bodies meshed there.
TEST(FollowInSpace, rowsBeyondTheEndAreEmpty) {
  const SpacePoint by(1.4, 0, 0.02);
  for (const auto& [kind, degree] : all) {
    const Blocks drawn({0, 0, 0}, degree);
    const Blocks there(by, degree);
    ContactInterface moved = drawn.meet(kind, true);
    const Vector u1 = field(drawn.upperNodes, [&](const SpacePoint&) { return by; });
    moved.follow(u1, still(drawn.tableNodes));
    const ContactInterface meshed = there.meet(kind, false);
    std::vector<int> facing;
    for (int row = 0; row < moved.rows(); ++row)
      if (moved.faces(row)) facing.push_back(row);
    ASSERT_EQ(static_cast<int>(facing.size()), meshed.rows());
    EXPECT_LT(meshed.rows(), moved.rows());
    for (int i = 0; i < meshed.rows(); ++i) {
      EXPECT_EQ(moved.nonmortarNodes()[facing[i]], meshed.nonmortarNodes()[i]);
      EXPECT_LE((Vector(moved.C1().row(facing[i])) - Vector(meshed.C1().row(i))).norm(), rounding);
      EXPECT_LE((Vector(moved.C2().row(facing[i])) - Vector(meshed.C2().row(i))).norm(), rounding);
      EXPECT_NEAR(moved.distanceHere()[facing[i]], meshed.initialDistance()[i], rounding);
    }
    for (int row = 0; row < moved.rows(); ++row)
      if (!moved.faces(row)) {
        EXPECT_EQ(Vector(moved.C1().row(row)).norm(), 0);
        EXPECT_GT(moved.distanceHere()[row], 0.5);
      }
  }
}

TEST(FollowInSpace, motionOfAllChangesNoGap) {
  const Eigen::Matrix3d turn = Eigen::AngleAxisd(2.1, SpacePoint(1, 2, -1).normalized()).toRotationMatrix();
  for (const double stiffness : {0.5, 2.0})
    for (const auto& [kind, degree] : all) {
      const Blocks drawn({0.2, 0.1, 0.1}, degree);
      ContactInterface moved = drawn.meet(kind, true, stiffness);
      const auto motion = [&](const SpacePoint& x) -> SpacePoint {
        return turn * x + SpacePoint(10, -7, 3) - x;
      };
      const ContactInterface before = moved;
      moved.follow(field(drawn.upperNodes, motion), field(drawn.tableNodes, motion));
      for (int row = 0; row < moved.rows(); ++row) {
        ASSERT_EQ(moved.faces(row), before.faces(row));
        EXPECT_NEAR(moved.distanceHere()[row], before.distanceHere()[row], 50 * rounding);
        EXPECT_LE((moved.normals()[row] - turn * before.normals()[row]).norm(), 10 * rounding);
        for (const size_t a : {0, 1})
          EXPECT_LE((moved.tangents()[row][a] - turn * before.tangents()[row][a]).norm(), 10 * rounding);
      }
    }
}

// Where surfaces touch, C is the derivative of the gap: by how much moving towards each other closes it.
TEST(FollowInSpace, rowsAreTheDerivativeOfTheGapWhereSurfacesTouch) {
  constexpr double h = 1e-6;
  for (const int degree : {1, 2}) {
    const Blocks drawn({0, 0, 0}, degree);
    ContactInterface moved = drawn.meet(CouplingKind::weighted, true);
    const auto tilted = [](const SpacePoint& x) { return SpacePoint(0.1, 0, 0.2 * x.x() - 0.1 * x.y()); };
    const Vector u1 = field(drawn.upperNodes, tilted);
    const Vector u2 = field(drawn.tableNodes, tilted);  // a shear, which keeps what touches
    moved.follow(u1, u2);
    EXPECT_LE(moved.distanceHere().lpNorm<Eigen::Infinity>(), 10 * rounding);
    const auto wave = [](const SpacePoint& x) {
      return SpacePoint(std::sin(2 * x.y()), std::cos(x.x()), std::sin(2 * x.x() + x.y()));
    };
    const Vector du1 = field(drawn.upperNodes, wave);
    const Vector expected = moved.jump(du1, still(drawn.tableNodes));
    moved.follow(u1 + h * du1, u2);
    const Vector change = -moved.distanceHere() / h;
    EXPECT_LE((change - expected).lpNorm<Eigen::Infinity>(), 1e-5 * expected.lpNorm<Eigen::Infinity>())
        << "degree " << degree;
  }
}

// As vertices of one surface pass edges of the other one rows change, and not by jumps.
TEST(FollowInSpace, rowsAreContinuousInTheMotion) {
  for (const Kind& each : {Kind{CouplingKind::mortar, 1}, Kind{CouplingKind::weighted, 2}}) {
    const Blocks drawn({0, 0, 0}, each.degree);
    ContactInterface moved = drawn.meet(each.coupling, true, 0.5);
    const Vector u2 =
        field(drawn.tableNodes, [](const SpacePoint& x) { return SpacePoint(0, 0, 1e-2 * std::sin(x.x())); });
    Vector before;
    constexpr double step = 1e-7;
    for (int i = -20; i <= 20; ++i) {
      const double by = -1.0 / 7 + (i + 0.5) * step;  // the table has vertices at x = -1 + 3 k / 7
      const Vector u1 = field(drawn.upperNodes, [&](const SpacePoint&) { return SpacePoint(by, 0, 0.02); });
      moved.follow(u1, u2);
      const Vector gap = moved.distanceHere();
      if (before.size() > 0) {
        EXPECT_LE((gap - before).lpNorm<Eigen::Infinity>(), 0.1 * step);
      }
      before = gap;
    }
  }
}

// A ball that rolls keeps its distance: its nodes go where a rotation by the vector of its angles takes them.
TEST(FollowInSpace, placesOfAToolThatTurnsAreThoseOfARotation) {
  RigidMotion motion;
  motion.at = {0.3, -0.2, 0.5};
  motion.held.resize(6);
  motion.force.resize(6);
  motion.turns = true;
  Conditions conditions;
  conditions.rigid = motion;
  const Body body("tool", cuboidMesh({{0, 0, 0}, {1, 1, 1}, {2, 2, 2}}),
                  elasticMaterial({1, 0.3}, Plane::none), std::move(conditions), 1);
  const SpacePoint angles(1.1, -0.4, 2.3);
  Vector q(6);
  q << 0.2, 0.4, -0.1, angles;
  const Eigen::Matrix3d turn = Eigen::AngleAxisd(angles.norm(), angles.normalized()).toRotationMatrix();
  const Vector u = body.displacementOf(q);
  const Vector moved = body.moved(u);
  std::vector<int> nodes;
  for (int node = 0; node < body.nodes(); ++node) {
    nodes.push_back(node);
    const SpacePoint x = body.placeOfNode(node);
    EXPECT_LE((x + moved.segment<3>(3 * node) - motion.at - q.head<3>() - turn * (x - motion.at)).norm(),
              rounding);
  }
  constexpr double h = 1e-6;
  const Eigen::SparseMatrix<double> change = body.changeOfMoved(u, nodes);
  for (int c = 0; c < 6; ++c) {
    const Vector along = body.displacementOf(Vector::Unit(6, c));
    const Vector difference = (body.moved(u + h * along) - body.moved(u - h * along)) / (2 * h);
    EXPECT_LE((change * along - difference).norm(), 1e-8);
  }
}

}  // namespace
}  // namespace mortier::follow_in_space_test
