// Bodies that do not strain.
#include <gtest/gtest.h>

#include <cmath>

#include "fem/body.h"
#include "fem/rigid_modes.h"
#include "material/elasticity.h"
#include "mesh/shape.h"

namespace mortier::rigid_body_test {

Datum datum(Function function) {
  return {std::move(function)};
}

/// A square about (1, 1), that turns about a point, a corner of itself if none is given.
Body square(RigidMotion motion, const Point& at = {0, 0}) {
  motion.at = asSpacePoint(at);
  motion.held.resize(3);
  motion.force.resize(3);
  Conditions conditions;
  conditions.rigid = std::move(motion);
  return {"tool", outlineMesh({{{0, 0}, {2, 0}, {2, 2}, {0, 2}}, {1, 2, 3, 4}}), elasticMaterial({1, 0.3}),
          std::move(conditions)};
}

const Datum zero = datum([](double, double, double) { return 0.0; });

TEST(RigidBody, movesAsPrescribed) {
  const Body body = square({{},
                            {datum([](double, double, double t) { return 3 * t; }), zero,
                             datum([](double, double, double t) { return 0.1 * t; })},
                            {}});
  EXPECT_TRUE(body.rigid());
  EXPECT_EQ(body.freeDofs(), 0);
  EXPECT_EQ(body.points(), 0);
  Vector u = Vector::Ones(body.dofs());
  body.prescribe(2, u);
  for (int node = 0; node < body.nodes(); ++node) {
    const Point x = body.mesh().vertices[node];
    EXPECT_NEAR((u.segment<2>(2 * node) - Point(6 - 0.2 * x.y(), 0.2 * x.x())).norm(), 0, 1e-15);
  }
  EXPECT_NEAR((body.motionOf(u) - Eigen::Vector3d(6, 0, 0.2)).norm(), 0, 1e-14);
  EXPECT_EQ(rigidModes(body).cols(), 0);
}

TEST(RigidBody, freeMotionsStay) {
  const Body body = square({{}, {zero, Datum(), Datum()}, {}});
  EXPECT_EQ(body.freeDofs(), 2);
  Vector x(2);
  x << 0.3, -0.2;
  Vector u = body.spread(x);
  const Eigen::Vector3d before = body.motionOf(u);
  u.array() += 1;  // along x and y
  body.prescribe(1, u);
  EXPECT_NEAR((body.motionOf(u) - before - Eigen::Vector3d(0, 1, 0)).norm(), 0, 1e-14);
  TwoPartVector increment{u, Vector::Zero(u.size())};
  body.prescribeIncrement(0, 1, increment);
  EXPECT_NEAR((increment.value() - u).norm(), 0, 1e-14);
}

TEST(RigidBody, forcesDoTheirWork) {
  const Body body = square({{},
                            {zero, Datum(), Datum()},
                            {Datum(), datum([](double, double, double t) { return -5 * t; }),
                             datum([](double, double, double) { return 0.7; })}});
  const Vector load = body.load(2);
  Point force(0, 0);
  double moment = 0;
  for (int node = 0; node < body.nodes(); ++node) {
    force += load.segment<2>(2 * node);
    moment += cross(body.mesh().vertices[node], load.segment<2>(2 * node));
  }
  EXPECT_NEAR((force - Point(0, -10)).norm(), 0, 1e-14);
  EXPECT_NEAR(moment, 0.7, 1e-14);
  // Of what is held the force is a reaction, the rest is to be in balance.
  const Vector push = load + Vector::Unit(body.dofs(), 0);
  EXPECT_NEAR((body.heldForce(push) - Eigen::Vector3d(1, 0, 0)).norm(), 0, 1e-14);
  EXPECT_NEAR((body.gather(push) - body.gather(load)).norm(), 0, 1e-14);
}

const Point pivot(-0.7, 3.1);

/// The square, free to turn by finite angles.
Body turningSquare() {
  return square({{}, {}, {}, true}, pivot);
}

/// The displacement (dofs) that stands for a motion.
Vector standsFor(const Body& body, const Eigen::Vector3d& motion) {
  Vector u(body.dofs());
  for (int node = 0; node < body.nodes(); ++node) {
    const Point arm = body.mesh().vertices[node] - pivot;
    u.segment<2>(2 * node) = motion.head<2>() + motion[2] * Point(-arm.y(), arm.x());
  }
  return u;
}

constexpr double fullTurn = 2 * M_PI;
constexpr double rounding = 1e-14;  // of places of order one, and angles of up to some turns

TEST(RigidBody, fullTurnsReturn) {
  const Body body = turningSquare();
  ASSERT_TRUE(body.turns());
  for (const int turns : {1, -1, 3})
    EXPECT_NEAR(body.moved(standsFor(body, {0, 0, turns * fullTurn})).lpNorm<Eigen::Infinity>(), 0,
                3 * rounding);
  const Eigen::Vector3d motion(0.4, -2, 0.9);
  const Vector once = body.moved(standsFor(body, motion));
  const Vector later = body.moved(standsFor(body, motion + Eigen::Vector3d(0, 0, fullTurn)));
  EXPECT_NEAR((later - once).lpNorm<Eigen::Infinity>(), 0, 3 * rounding);
}

TEST(RigidBody, turnedBodiesKeepTheirShape) {
  const Body body = turningSquare();
  const std::vector<Point>& x = body.mesh().vertices;
  for (const double angle : {0.3, M_PI / 2, -2.5, 5.0}) {
    const Point by(1.5, -0.25);
    const Vector u = body.moved(standsFor(body, {by.x(), by.y(), angle}));
    for (int a = 0; a < body.nodes(); ++a) {
      const Point arm = x[a] - pivot;
      const Point there = x[a] + u.segment<2>(2 * a) - pivot - by;
      EXPECT_NEAR(there.norm(), arm.norm(), rounding);  // about the moved reference point
      EXPECT_NEAR(cross(arm, there), std::sin(angle) * arm.squaredNorm(), 20 * rounding);
      EXPECT_NEAR(arm.dot(there), std::cos(angle) * arm.squaredNorm(), 20 * rounding);
      for (int b = 0; b < a; ++b)
        EXPECT_NEAR((x[b] + u.segment<2>(2 * b) - x[a] - u.segment<2>(2 * a)).norm(), (x[b] - x[a]).norm(),
                    rounding);
    }
  }
}

TEST(RigidBody, changeOfMovedIsItsDerivative) {
  const Body body = turningSquare();
  std::vector<int> all(body.nodes());
  for (int node = 0; node < body.nodes(); ++node) all[node] = node;
  const Eigen::Vector3d motion(0.2, 0.5, 1.1);
  constexpr double h = 1e-5;  // central differences: h^2 / 6 of arms of length 4
  const Vector u = standsFor(body, motion);
  for (int c = 0; c < 3; ++c) {
    const Eigen::Vector3d unit = Eigen::Vector3d::Unit(c);
    const Vector difference =
        (body.moved(standsFor(body, motion + h * unit)) - body.moved(standsFor(body, motion - h * unit))) /
        (2 * h);
    const Vector change = body.changeOfMoved(u, all) * standsFor(body, unit);
    EXPECT_NEAR((change - difference).lpNorm<Eigen::Infinity>(), 0, 1e-9);
    const Vector ofTwo = body.changeOfMoved(u, {1, 2}) * standsFor(body, unit);
    EXPECT_NEAR((ofTwo - change).segment<4>(2).norm(), 0, 10 * rounding);
    EXPECT_EQ(ofTwo.segment<2>(0).norm(), 0);
  }
}

TEST(RigidBody, forcesOnTurnedBodiesHaveMomentsAboutTheMovedPoint) {
  const Body body = square({{}, {zero, zero, zero}, {}, true}, pivot);  // heldForce() is that of held motions
  const Eigen::Vector3d motion(0.2, 0.5, 1.1);
  const Vector u = standsFor(body, motion);
  const Vector by = body.moved(u);
  Vector nodal = Vector::Zero(body.dofs());
  nodal.segment<4>(2) << 1, -2, 0.5, 3;
  Point force(0, 0);
  double moment = 0;
  for (int node = 0; node < body.nodes(); ++node) {
    const Point there = body.mesh().vertices[node] + by.segment<2>(2 * node);
    force += nodal.segment<2>(2 * node);
    moment += cross(there - pivot - motion.head<2>(), nodal.segment<2>(2 * node));
  }
  const Eigen::Vector3d work = body.heldForce(body.changeOfMoved(u, {1, 2}).transpose() * nodal);
  EXPECT_NEAR((work - Eigen::Vector3d(force.x(), force.y(), moment)).norm(), 0, 20 * rounding);
}

TEST(RigidBody, whatDoesNotTurnMovesByItsDisplacement) {
  const Body body = square({{}, {}, {}}, pivot);
  const Vector u = standsFor(body, {0.1, 0.2, 0.3});
  EXPECT_EQ((body.moved(u) - u).norm(), 0);
}

TEST(RigidBody, inSpaceMovesAlongAndTurnsAboutThreeAxes) {
  const SpacePoint at(0.3, -1, 2);
  const SpacePoint by(0.1, 0.2, -0.3);
  const SpacePoint angles(0.02, -0.05, 0.07);
  const SpacePoint force(3, -5, 7);
  const SpacePoint moment(0.4, 0.5, -0.6);
  const auto constant = [](double value) { return datum([=](double, double, double) { return value; }); };
  RigidMotion held{at, {}, std::vector<Datum>(6)};
  RigidMotion pushed{at, std::vector<Datum>(6), {}};
  for (int c = 0; c < 6; ++c) {
    held.held.push_back(constant(c < 3 ? by[c] : angles[c - 3]));
    pushed.force.push_back(constant(c < 3 ? force[c] : moment[c - 3]));
  }
  const auto cuboid = [](RigidMotion motion) {
    Conditions conditions;
    conditions.rigid = std::move(motion);
    return Body("tool", cuboidMesh({{0, 0, 0}, {1, 2, 3}, {2, 1, 2}}), elasticMaterial({1, 0.3}, Plane::none),
                std::move(conditions), 1);
  };
  const Body moved = cuboid(held);
  Vector u = Vector::Zero(moved.dofs());
  moved.prescribe(1, u);
  for (int node = 0; node < moved.nodes(); ++node) {
    const SpacePoint expected = by + angles.cross(moved.placeOfNode(node) - at);
    EXPECT_NEAR((SpacePoint(u.segment<3>(3 * node)) - expected).norm(), 0, 1e-15);
  }
  EXPECT_NEAR((moved.motionOf(u).tail<3>() - angles).norm(), 0, 1e-14);
  const Body free = cuboid(pushed);
  EXPECT_EQ(free.freeDofs(), 6);
  EXPECT_EQ(rigidModes(free).cols(), 6);
  const Vector load = free.load(1);
  SpacePoint sum = SpacePoint::Zero();
  SpacePoint turning = SpacePoint::Zero();
  for (int node = 0; node < free.nodes(); ++node) {
    sum += load.segment<3>(3 * node);
    turning += (free.placeOfNode(node) - at).cross(SpacePoint(load.segment<3>(3 * node)));
  }
  EXPECT_NEAR((sum - force).norm(), 0, 1e-13);
  EXPECT_NEAR((turning - moment).norm(), 0, 1e-13);
  EXPECT_NEAR((moved.heldForce(load).head<3>() - force).norm(), 0, 1e-13);
  EXPECT_NEAR((moved.heldForce(load).tail<3>() - moment).norm(), 0, 1e-13);
  EXPECT_NEAR((moved.sharesIn(4).dot(u) - angles.y()), 0, 1e-14);
}

}  // namespace mortier::rigid_body_test
