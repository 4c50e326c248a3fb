// Rows that follow the bodies (ContactInterface::follow).
#include <gtest/gtest.h>

#include <cmath>

#include "contact/interface.h"
#include "mesh/generate.h"

namespace mortier::follow_test {

constexpr int bottom = 1;
constexpr int top = 3;
constexpr double rounding = 1e-13;  // of lengths of order one
constexpr CouplingKind all[] = {CouplingKind::interpolation, CouplingKind::mortar, CouplingKind::weighted};

/// A block above a table that is wider; the block is nonmortar.
struct Blocks {
  TriangleMesh upper;
  TriangleMesh table = crissCrossMesh({.lower = {-2, -1}, .upper = {3, 0}, .cellsX = 13, .cellsY = 2});
  int degree = 1;

  explicit Blocks(double x = 0, double y = 0, int ofDegree = 1)
      : upper(crissCrossMesh({.lower = {x, y}, .upper = {x + 1, y + 1}, .cellsX = 5, .cellsY = 2})),
        degree(ofDegree) {}

  [[nodiscard]] ContactInterface meet(CouplingKind kind, bool follows, double friction = 0,
                                      bool upperNonmortar = true) const {
    const ContactSide one{0, bottom};
    const ContactSide two{1, top};
    InterfaceOptions options;
    options.follows = follows;
    options.friction.coefficient = friction;
    const ElementNodes upperNodes = elementNodes(upper, degree);
    const ElementNodes tableNodes = elementNodes(table, degree);
    if (upperNonmortar)
      return {{one, two, kind}, ContactMesh{upper, upperNodes}, ContactMesh{table, tableNodes}, options};
    return {{two, one, kind}, ContactMesh{table, tableNodes}, ContactMesh{upper, upperNodes}, options};
  }
};

/// Displacements of a mesh that a function of the place gives.
template <class F>
Vector field(const TriangleMesh& mesh, int degree, F u) {
  const std::vector<Point> places = elementNodes(mesh, degree).places;
  Vector result(2 * static_cast<Eigen::Index>(places.size()));
  for (size_t v = 0; v < places.size(); ++v)
    result.segment<2>(2 * static_cast<Eigen::Index>(v)) = u(places[v]);
  return result;
}

TEST(Follow, rowsAreThoseOfBodiesMeshedThere) {
  const Point by(0.37, 0.02);
  for (const int degree : {1, 2})
    for (const CouplingKind kind : all) {
      const Blocks drawn(0, 0, degree);
      const Blocks there(by.x(), by.y(), degree);
      ContactInterface moved = drawn.meet(kind, true);
      const Vector u1 = field(drawn.upper, degree, [&](const Point&) { return by; });
      const Vector u2 = field(drawn.table, degree, [](const Point&) { return Point(0, 0); });
      moved.follow(u1, u2);
      const ContactInterface meshed = there.meet(kind, false);
      std::vector<int> facing;
      for (int row = 0; row < moved.rows(); ++row)
        if (moved.faces(row)) facing.push_back(row);
      ASSERT_EQ(static_cast<int>(facing.size()), meshed.rows());
      for (int i = 0; i < meshed.rows(); ++i) {
        EXPECT_EQ(moved.nonmortarNodes()[facing[i]], meshed.nonmortarNodes()[i]);
        EXPECT_LE((Vector(moved.C1().row(facing[i])) - Vector(meshed.C1().row(i))).norm(), rounding);
        EXPECT_LE((Vector(moved.C2().row(facing[i])) - Vector(meshed.C2().row(i))).norm(), rounding);
        EXPECT_NEAR(moved.gap(u1, u2)[facing[i]], -meshed.initialDistance()[i], rounding);
      }
      EXPECT_NEAR(moved.interpenetration(u1, u2), 0, rounding);
    }
}

TEST(Follow, motionOfAllChangesNoGap) {
  const double angle = 0.7;
  for (const bool upperNonmortar : {true, false})
    for (const CouplingKind kind : all) {
      const Blocks drawn(0.2, 0.1);
      ContactInterface moved = drawn.meet(kind, true, 0.3, upperNonmortar);
      const auto turn = [&](const Point& x) {
        return Point(std::cos(angle) * x.x() - std::sin(angle) * x.y() + 10 - x.x(),
                     std::sin(angle) * x.x() + std::cos(angle) * x.y() - 7 - x.y());
      };
      const Vector upper = field(drawn.upper, 1, turn);
      const Vector table = field(drawn.table, 1, turn);
      const ContactInterface before = moved;
      if (upperNonmortar)
        moved.follow(upper, table);
      else
        moved.follow(table, upper);
      for (int row = 0; row < moved.rows(); ++row) {
        ASSERT_EQ(moved.faces(row), before.faces(row));
        EXPECT_NEAR(moved.distanceHere()[row], before.distanceHere()[row], 20 * rounding);
        if (!moved.faces(row)) continue;
        const Point n = before.normals()[row].head<2>();
        const Point turned(std::cos(angle) * n.x() - std::sin(angle) * n.y(),
                           std::sin(angle) * n.x() + std::cos(angle) * n.y());
        EXPECT_LE((moved.normals()[row].head<2>() - turned).norm(), rounding);
      }
    }
}

/// As nodes of one line pass those of the other, rows change, and not by jumps.
TEST(Follow, rowsAreContinuousInTheMotion) {
  const Blocks drawn;
  for (const CouplingKind kind : {CouplingKind::mortar, CouplingKind::weighted}) {
    ContactInterface moved = drawn.meet(kind, true);
    const Vector u2 = field(drawn.table, 1, [](const Point& x) { return Point(0, 1e-2 * std::sin(x.x())); });
    Vector before;
    constexpr double step = 1e-7;
    const double pass = 2.0 / 13;  // a node of the table is under the first one of the block there
    for (int i = -20; i <= 20; ++i) {
      const double by = -pass + (i + 0.5) * step;
      const Vector u1 = field(drawn.upper, 1, [&](const Point&) { return Point(by, 0.02); });
      moved.follow(u1, u2);
      const Vector gap = moved.distanceHere();
      if (before.size() > 0) {
        EXPECT_LE((gap - before).lpNorm<Eigen::Infinity>(), 0.1 * step);
      }
      before = gap;
    }
  }
}

TEST(Follow, rowsComeAndGoAtEnds) {
  const Blocks drawn;
  ContactInterface moved = drawn.meet(CouplingKind::weighted, true, 0, false);  // the table is nonmortar
  const Vector still = field(drawn.table, 1, [](const Point&) { return Point(0, 0); });
  const auto facing = [&] {
    int count = 0;
    for (int row = 0; row < moved.rows(); ++row) count += moved.faces(row) ? 1 : 0;
    return count;
  };
  const auto move = [&](double by, bool keepRows = false) {
    moved.follow(still, field(drawn.upper, 1, [&](const Point&) { return Point(by, 0.0); }), keepRows);
  };
  EXPECT_EQ(facing(), 2);  // at -2 + 5/13 k, between 0 and 1
  move(0.1);
  const int there = facing();
  move(0.25, true);
  EXPECT_LE(facing(), there);  // none is new
  move(10);
  EXPECT_EQ(facing(), 0);
  EXPECT_TRUE((moved.distanceHere().array() > 0).all());
  EXPECT_TRUE(moved.contactPressure(Vector::Zero(moved.rows())).isZero(0));
  move(0);
  EXPECT_EQ(facing(), 2);
}

}  // namespace mortier::follow_test
