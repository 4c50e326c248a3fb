#include "contact/interface.h"

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>
#include <random>

#include "mesh/generate.h"
#include "unit/messages.h"

namespace mortier::interface_test {

constexpr int bottom = 1;
constexpr int top = 3;
constexpr double rounding = 1e-14;  // of lengths and forces of order one

TriangleMesh block(Point lower, Point upper, int cells) {
  return crissCrossMesh({.lower = lower, .upper = upper, .cellsX = cells, .cellsY = 2});
}

TriangleMesh turned(TriangleMesh mesh, double angle) {
  const Eigen::Matrix2d rotation{{std::cos(angle), -std::sin(angle)}, {std::sin(angle), std::cos(angle)}};
  for (Point& x : mesh.vertices) x = rotation * x;
  return mesh;
}

/// An upper and a lower block that meet on y = 0; body 0 is the upper one.
struct Blocks {
  TriangleMesh upper;
  TriangleMesh lower;

  explicit Blocks(int upperCells, int lowerCells, double distance = 0)
      : upper(block({0, distance}, {1, 1 + distance}, upperCells)),
        lower(block({0, -1}, {1, 0}, lowerCells)) {}

  [[nodiscard]] ContactInterface meet(CouplingKind kind = CouplingKind::mortar,
                                      bool upperNonmortar = true) const {
    const ContactSide upperSide{0, bottom};
    const ContactSide lowerSide{1, top};
    if (upperNonmortar) return {{upperSide, lowerSide, kind}, upper, lower};
    return {{lowerSide, upperSide, kind}, lower, upper};
  }
};

/// A displacement by dofs from functions of the place.
template <class F>
Vector field(const TriangleMesh& mesh, F u) {
  Vector result(2 * mesh.vertices.size());
  for (size_t v = 0; v < mesh.vertices.size(); ++v) result.segment<2>(2 * v) = u(mesh.vertices[v]);
  return result;
}

Vector still(const TriangleMesh& mesh) {
  return Vector::Zero(2 * mesh.vertices.size());
}

TEST(Interface, gapIsPositiveWhereBodiesOverlap) {
  for (const bool upperNonmortar : {true, false}) {
    const Blocks blocks(4, 6, 0.125);
    const ContactInterface interface = blocks.meet(CouplingKind::mortar, upperNonmortar);
    for (const SpacePoint& n : interface.normals())
      EXPECT_EQ(n, upperNonmortar ? SpacePoint(0, -1, 0) : SpacePoint(0, 1, 0));
    EXPECT_EQ(interface.overlap(), 1);
    EXPECT_LE((interface.initialDistance().array() - 0.125).abs().maxCoeff(), rounding);
    const Vector lifted = field(blocks.lower, [](const Point&) { return Point(7, 0.25); });
    const Vector gap = upperNonmortar ? interface.gap(still(blocks.upper), lifted)
                                      : interface.gap(lifted, still(blocks.upper));
    EXPECT_LE((gap.array() - 0.125).abs().maxCoeff(), rounding);
    const Vector open = upperNonmortar ? interface.gap(still(blocks.upper), still(blocks.lower))
                                       : interface.gap(still(blocks.lower), still(blocks.upper));
    EXPECT_LE((open.array() + 0.125).abs().maxCoeff(), rounding);
  }
}

TEST(Interface, slopedLinesHaveTheirNormal) {
  for (int degrees = -180; degrees < 180; degrees += 7) {
    const double angle = degrees * std::numbers::pi / 180;
    Blocks blocks(5, 3);
    blocks.upper = turned(blocks.upper, angle);
    blocks.lower = turned(blocks.lower, angle);
    const ContactInterface interface = blocks.meet();
    const Point normal(std::sin(angle), -std::cos(angle));
    const Point tangent(normal.y(), -normal.x());
    for (const SpacePoint& n : interface.normals()) EXPECT_LE((n.head<2>() - normal).norm(), rounding);
    EXPECT_EQ(interface.rows(), 6);
    EXPECT_EQ(interface.initialDistance().cwiseAbs().maxCoeff(), 0);
    const Vector moved = field(blocks.upper, [&](const Point&) { return Point(0.5 * normal + 3 * tangent); });
    EXPECT_LE((interface.gap(moved, still(blocks.lower)).array() - 0.5).abs().maxCoeff(), rounding);
  }
}

TEST(Interface, wrongPairsAreRefused) {
  const Blocks blocks(4, 6);
  const auto pair = [](int nonmortar, int mortar) {
    return ContactPair{{0, nonmortar}, {1, mortar}, CouplingKind::mortar};
  };
  const auto expect = [&](const ContactPair& sides, const TriangleMesh& lower, const std::string& what) {
    const std::string message = messageOf([&] { ContactInterface(sides, blocks.upper, lower); });
    EXPECT_NE(message.find(what), std::string::npos) << message;
  };
  expect(pair(bottom, top), blocks.lower, "no error");
  expect(pair(bottom, bottom), blocks.lower,
         "do not face each other: their outward normals make an angle of 0 degrees");
  expect(pair(bottom, 2), blocks.lower, "an angle of 90 degrees, expected 180");
  expect(pair(bottom, top), block({2, -1}, {3, 0}, 6), "overlap at no nonmortar node");
  expect(pair(bottom, top), block({0.3, -1}, {0.45, 0}, 6), "overlap at no nonmortar node");
  expect(pair(bottom, top), block({0, -1}, {1, 0.125}, 6), "penetrate each other by 0.125 as meshed");
}

// The forces are the transpose of the gap, they balance, and so do their moments: linear functions are
// reproduced.
TEST(Interface, forcesBalance) {
  std::mt19937 random(1);
  std::uniform_real_distribution<double> value(-1, 1);
  for (const CouplingKind kind : {CouplingKind::mortar, CouplingKind::interpolation})
    for (const bool upperNonmortar : {true, false})
      for (const double degrees : {0.0, 33.0, 89.0}) {
        Blocks blocks(7, 11);
        blocks.upper = turned(blocks.upper, degrees * std::numbers::pi / 180);
        blocks.lower = turned(blocks.lower, degrees * std::numbers::pi / 180);
        const ContactInterface interface = blocks.meet(kind, upperNonmortar);
        const TriangleMesh& first = upperNonmortar ? blocks.upper : blocks.lower;
        const TriangleMesh& second = upperNonmortar ? blocks.lower : blocks.upper;
        Vector p(interface.rows());
        for (double& x : p) x = value(random);
        Vector f1 = still(first);
        Vector f2 = still(second);
        interface.subtractForces(p, f1, f2);
        Point total = Point::Zero();
        double moment = 0;
        for (const auto& [mesh, f] : {std::pair(&first, &f1), std::pair(&second, &f2)})
          for (size_t v = 0; v < mesh->vertices.size(); ++v) {
            const Point force = f->segment<2>(2 * v);
            total += force;
            moment += mesh->vertices[v].x() * force.y() - mesh->vertices[v].y() * force.x();
          }
        EXPECT_LE(total.norm(), rounding);
        EXPECT_LE(std::abs(moment), rounding);

        const auto noise = [&](const Point&) { return Point(value(random), value(random)); };
        const Vector u1 = field(first, noise);
        const Vector u2 = field(second, noise);
        EXPECT_NEAR(p.dot(interface.gap(u1, u2)), -(f1.dot(u1) + f2.dot(u2)), rounding);
      }
}

TEST(Interface, pressureOfAUniformLoadIsUniform) {
  const Blocks blocks(5, 8);
  const ContactInterface interface = blocks.meet();
  Vector p = Vector::Constant(6, 0.2 * 3);
  p[0] = p[5] = 0.1 * 3;
  EXPECT_LE((interface.contactPressure(p).array() - 3).abs().maxCoeff(), rounding);
}

// Upper nodes at 0, 1/2, 1, lower ones at 0, 1/3, 2/3, 1.
TEST(Interface, interpenetrationIsExact) {
  const Blocks blocks(2, 3);
  const auto hat = [](const Point& x) { return Point(0, -(1 - 2 * std::abs(x.x() - 0.5))); };
  const auto integral = [&](auto upperMotion, auto lowerMotion, bool upperNonmortar) {
    const ContactInterface interface = blocks.meet(CouplingKind::mortar, upperNonmortar);
    const Vector u1 = field(blocks.upper, upperMotion);
    const Vector u2 = field(blocks.lower, lowerMotion);
    return upperNonmortar ? interface.interpenetration(u1, u2) : interface.interpenetration(u2, u1);
  };
  const auto down = [](double by) { return [by](const Point&) { return Point(0, -by); }; };
  for (const bool upperNonmortar : {true, false}) {
    // The jump is a hat of height 1 on [0, 1].
    EXPECT_NEAR(integral(hat, down(0), upperNonmortar), 1.0 / 2, rounding);
    // That hat less 1/2: a triangle of base 1/2 and height 1/2.
    EXPECT_NEAR(integral(hat, down(0.5), upperNonmortar), 1.0 / 8, rounding);
    // The hat less s: s on [0, 1/2], 2 - 3 s up to 2/3.
    const auto slope = [](const Point& x) { return Point(0, -x.x()); };
    EXPECT_NEAR(integral(hat, slope, upperNonmortar), 1.0 / 8 + 1.0 / 24, rounding);
    // A lower hat at 1/3 against a plane at 1/4: base 3/4 of [0, 2/3], height 3/4.
    const auto lowerHat = [](const Point& x) { return Point(0, std::abs(x.x() - 1.0 / 3) < 1e-9 ? 1 : 0); };
    EXPECT_NEAR(integral([](const Point&) { return Point(0, 0.25); }, lowerHat, upperNonmortar), 3.0 / 16,
                rounding);
    EXPECT_EQ(integral(down(-1), down(0), upperNonmortar), 0);
    EXPECT_NEAR(integral(down(1), down(-1), upperNonmortar), 2, rounding);
  }
}

// Away from the part that faces the other body nothing interpenetrates.
TEST(Interface, interpenetrationCountsWhatFacesOnly) {
  Blocks blocks(4, 6);
  blocks.lower = block({0.5, -1}, {2, 0}, 6);
  const Vector down = field(blocks.upper, [](const Point&) { return Point(0, -0.1); });
  const ContactInterface interface = blocks.meet();
  EXPECT_NEAR(interface.interpenetration(down, still(blocks.lower)), 0.1 * 0.5, rounding);
  EXPECT_NEAR(interface.overlap(), 0.5, rounding);
  EXPECT_EQ(interface.rows(), 3);
}

}  // namespace mortier::interface_test
