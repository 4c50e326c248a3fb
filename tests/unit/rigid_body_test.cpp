// Bodies that do not strain.
#include <gtest/gtest.h>

#include "fem/body.h"
#include "fem/rigid_modes.h"
#include "material/elasticity.h"
#include "mesh/outline.h"

namespace mortier::rigid_body_test {

Datum datum(Function function) {
  return {std::move(function)};
}

/// A square about (1, 1), that turns about a corner of itself.
Body square(RigidMotion motion) {
  motion.at = {0, 0};
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

}  // namespace mortier::rigid_body_test
