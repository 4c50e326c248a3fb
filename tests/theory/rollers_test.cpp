// Rollers on sloped sides, pressure on curved sides: exact solutions that P1 has in its space, and balances.
#include <gtest/gtest.h>

#include <Eigen/Geometry>

#include <cmath>
#include <iostream>

#include "theory/scenes.h"

namespace mortier::rollers_test {

using namespace scenes;

Body turnedSquare(double angle, Conditions conditions, const std::shared_ptr<const Material>& material) {
  TriangleMesh mesh = crissCrossMesh({.lower = {0, 0}, .upper = {1, 1}, .cellsX = 4, .cellsY = 3});
  const Eigen::Rotation2Dd turn(angle);
  for (Point& x : mesh.vertices) x = turn * x;
  return {"square", std::move(mesh), material, std::move(conditions)};
}

/// Stress in the axes of the square.
Eigen::Matrix2d turnedBack(const Eigen::Vector3d& pqr, double angle) {
  const Eigen::Vector3d s = toCartesian(pqr);
  const Eigen::Matrix2d R = Eigen::Rotation2Dd(angle).toRotationMatrix();
  return R.transpose() * Eigen::Matrix2d{{s[0], s[2]}, {s[2], s[1]}} * R;
}

// The compression test in one body, at any angle: normal rollers on two sides, pressure on the third.
TEST(Rollers, aPatchAtAnyAngleHasConstantStress) {
  constexpr double rounding = 1e-10;
  for (const double degrees : {0.0, 1e-3, 17.0, 45.0, 89.0, 90.0, 213.0})
    for (const Projection projection : {Projection::elasticity, Projection::frobenius}) {
      const double angle = degrees * M_PI / 180;
      Model model;
      model.bodies.push_back(
          turnedSquare(angle,
                       {{{left, alongNormal, constant(0)}, {bottom, alongNormal, constant(0)}},
                        {{top, alongNormal, [](double, double, double t) { return -10 * t; }}},
                        {}},
                       perzynaMaterial(noteElasticity, noteLaw(projection))));
      const Result result = run(model, 1, 10);
      ASSERT_EQ(result.report.status, Status::converged) << result.report.reason;
      const Body& body = model.bodies[0];
      const BodyState& state = result.state.bodies[0];
      for (int i = 0; i < body.points(); ++i) {
        const Eigen::Matrix2d s = turnedBack(state.stress.col(i), angle);
        EXPECT_NEAR(s(0, 0), 0, 10 * rounding);
        EXPECT_NEAR(s(1, 1), -10, 10 * rounding);
        EXPECT_NEAR(s(0, 1), 0, 10 * rounding);
      }
      // docs: backward Euler's sum for ten steps.
      const double expected = projection == Projection::elasticity ? -0.2185132334 : -0.2185530985;
      const Eigen::Rotation2Dd turn(angle);
      for (int v = 0; v < body.nodes(); ++v) {
        const Point x = turn.inverse() * body.mesh().vertices[v];
        const Point u = turn.inverse() * Point(state.displacement.segment<2>(2 * v));
        EXPECT_NEAR(u.y(), expected * x.y(), 1e-9);
      }
    }
}

// A displacement prescribed by normal and tangential parts on all sides: the linear field of the patch.
TEST(Rollers, prescribedMotionsOnSlopedSidesGiveTheLinearField) {
  constexpr double rounding = 1e-12;
  const double angle = 0.6;
  const Eigen::Matrix2d F{{0.02, -0.01}, {0.03, 0.01}};
  const Eigen::Matrix2d R = Eigen::Rotation2Dd(angle).toRotationMatrix();
  const Point normals[] = {R * Point(0, -1), R * Point(1, 0), R * Point(0, 1), R * Point(-1, 0)};
  Conditions conditions;
  for (const int label : {bottom, right, top, left}) {
    const Point n = normals[label - 1];
    const Point t(-n.y(), n.x());
    const auto along = [F](const Point& d) {
      return [F, d](double x, double y, double time) { return time * d.dot(F * Point(x, y)); };
    };
    conditions.displacements.push_back({label, alongNormal, along(n)});
    conditions.displacements.push_back({label, alongTangent, along(t)});
  }
  Model model;
  model.bodies.push_back(turnedSquare(angle, conditions, elasticMaterial({100, 0.3})));
  const Result result = run(model, 1, 1);
  ASSERT_EQ(result.report.status, Status::converged) << result.report.reason;
  for (int v = 0; v < model.bodies[0].nodes(); ++v)
    EXPECT_LE((result.state.bodies[0].displacement.segment<2>(2 * v) - F * model.bodies[0].mesh().vertices[v])
                  .norm(),
              rounding);
}

// Pressure on a closed curve, constant or from a fluid at rest (p = -rho y): resultants of the note's
// hydrostatics, nothing and the weight of what the polygon displaces; no moment about any point but for the
// weight.
TEST(Pressure, onAClosedCurveIsBalanced) {
  constexpr double rounding = 1e-14;
  const TriangleMesh mesh =
      annulusMesh({.centre = {3, 1}, .inner = 1, .outer = 2, .cellsAround = 13, .cellsAcross = 2});
  double inside = 0;  // area of the inner polygon
  for (size_t e = 0; e < mesh.boundaryEdges.size(); ++e)
    if (mesh.boundaryLabels[e] == 1) {
      const Point a = mesh.vertices[mesh.boundaryEdges[e][0]] - Point(3, 1);
      const Point b = mesh.vertices[mesh.boundaryEdges[e][1]] - Point(3, 1);
      inside -= (a.x() * b.y() - a.y() * b.x()) / 2;
    }
  const auto resultant = [&](const Function& normalTraction) {
    const Body body("ring", mesh, elasticMaterial({1, 0.3}), {{}, {{1, alongNormal, normalTraction}}, {}});
    const Vector f = body.load(0);
    Eigen::Vector3d sum = Eigen::Vector3d::Zero();
    for (int v = 0; v < body.nodes(); ++v) {
      const Point x = mesh.vertices[v] - Point(3, 1);
      sum += Eigen::Vector3d(f[2 * v], f[2 * v + 1], x.x() * f[2 * v + 1] - x.y() * f[2 * v]);
    }
    return sum;
  };
  EXPECT_LE(resultant(constant(-7)).norm(), 7 * rounding);
  // The fluid fills the hole: it pushes the ring down by its weight.
  const Eigen::Vector3d weight = resultant([](double, double y, double) { return y; });
  EXPECT_NEAR(weight.x(), 0, 4 * rounding);
  EXPECT_NEAR(weight.y(), -inside, 4 * rounding);
  EXPECT_NEAR(weight.z(), 0, 4 * rounding);
}

}  // namespace mortier::rollers_test
