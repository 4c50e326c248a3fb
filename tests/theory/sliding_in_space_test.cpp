// Contact that follows the bodies in space: the patch test moved far, full slip in any direction, energy, the
// end of a table.
#include <gtest/gtest.h>

#include <Eigen/Geometry>
#include <cmath>

#include "material/elasticity.h"
#include "mesh/shape.h"
#include "theory/sliding_bodies.h"

namespace mortier::sliding_in_space_test {

using namespace scenes;

constexpr double mu = 0.3;

struct Kind {
  Rows rows;
  int degree;
};
const Kind all[] = {{CouplingKind::weighted, 1},
                    {CouplingKind::weighted, 2},
                    {{CouplingKind::weighted, true}, 1},
                    {CouplingKind::mortar, 1}};

TetrahedronMesh turned(TetrahedronMesh mesh, const Eigen::Matrix3d& rotation) {
  for (SpacePoint& x : mesh.vertices) x = rotation * x;
  return mesh;
}

/// Supports of all components on a label, by a function of the time.
std::vector<Condition> moved(int label, const std::function<SpacePoint(double)>& by) {
  std::vector<Condition> conditions;
  for (const int c : {0, 1, 2})
    conditions.push_back({label, c, [by, c](const SpacePoint&, double t) { return by(t)[c]; }});
  return conditions;
}

// Blocks of different meshes under uniform pressure, turned, and moved together by ten widths: whatever it
// was, the pressure stays constant.
TEST(SlidingInSpace, patchIsExactWhereverItMoves) {
  constexpr double p = 2;
  constexpr double soft = 100;
  constexpr double hard = 300;
  const Eigen::Matrix3d rotation =
      Eigen::AngleAxisd(0.7, SpacePoint(1, -2, 0.5).normalized()).toRotationMatrix();
  const SpacePoint n = rotation.col(2);
  const SpacePoint way = rotation * SpacePoint(8, 6, 3);
  const SpacePoint down = -p * (1 / soft + 1 / hard) * n;
  for (const auto& [rows, degree] : all)
    for (const int nonmortar : {upperBody, lowerBody}) {
      const auto at = [&](const SpacePoint& first) {  // pressed at once, then moved
        return [=](double t) -> SpacePoint {
          return std::min(2 * t, 1.0) * first + std::max(2 * t - 1, 0.0) * way;
        };
      };
      Body upper("upper", turned(cuboidMesh({{0, 0, 0}, {1, 1, 1}, {3, 4, 2}}), rotation),
                 elasticMaterial({soft, 0}, Plane::none), {moved(top, at(down)), {}, {}}, degree);
      Body lower("lower", turned(cuboidMesh({{0, 0, -1}, {1, 1, 0}, {4, 3, 2}}), rotation),
                 elasticMaterial({hard, 0}, Plane::none), {moved(bottom, at({0, 0, 0})), {}, {}}, degree);
      const Model model = following(std::move(upper), std::move(lower), rows, nonmortar, mu,
                                    nonmortar == upperBody ? soft / hard : hard / soft);
      const Result result = run(model, 1, 6);
      ASSERT_EQ(result.report.status, Status::converged) << result.report.reason;
      const Vector pressure = model.interfaces[0].contactPressure(result.state.contactForce[0]);
      for (int row = 0; row < model.interfaces[0].rows(); ++row)
        if (model.interfaces[0].faces(row)) {
          EXPECT_NEAR(pressure[row], p, 1e-9 * p) << wordOf(rows) << ", degree " << degree;
        }
      EXPECT_LE(result.report.worst.forceBalance, 1e-11);
      EXPECT_LE(result.report.worst.gapOnActive, 1e-12);
    }
}

/// A block pressed onto a stiff table and pushed along it.
Model pushed(const Rows& coupling, int nonmortar, const SpacePoint& way, int degree) {
  const auto path = [way](double t) -> SpacePoint {
    return std::max(t - 0.25, 0.0) / 0.75 * way + SpacePoint(0, 0, -0.02 * std::min(4 * t, 1.0));
  };
  Body upper("upper", cuboidMesh({{0, 0, 0}, {1, 1, 1}, {3, 3, 2}}), elasticMaterial({100, 0.3}, Plane::none),
             {moved(top, path), {}, {}}, degree);
  Body lower("lower", cuboidMesh({{-0.5, -0.5, -1}, {3.5, 2.7, 0}, {8, 7, 1}}),
             elasticMaterial({1e14, 0.3}, Plane::none),
             {moved(bottom, [](double) { return SpacePoint(0, 0, 0); }), {}, {}}, degree);
  return following(std::move(upper), std::move(lower), coupling, nonmortar, mu,
                   nonmortar == upperBody ? 1e-12 : 1e12);
}

TEST(SlidingInSpace, forceOfFullSlipIsThatOfCoulombInAnyDirection) {
  for (const auto& [rows, degree] : all)
    for (const int nonmortar : {upperBody, lowerBody})
      for (const SpacePoint& way : {SpacePoint(2, 0, 0), SpacePoint(1.6, 1.2, 0)}) {
        const Model model = pushed(rows, nonmortar, way, degree);
        const Result result = run(model, 1, 8);
        ASSERT_EQ(result.report.status, Status::converged) << result.report.reason;
        const SpacePoint force = resultant(model, result.state, 0);
        EXPECT_NEAR(force.head<2>().norm(), mu * std::abs(force.z()), 1e-5 * mu * std::abs(force.z()))
            << wordOf(rows) << degree << nonmortar;
        // Nodes turn into the direction of the motion as they slip on: the resultant is less to second order.
        EXPECT_NEAR(std::abs(cross(Point(force.head<2>()), Point(way.head<2>()))), 0,
                    5e-3 * force.head<2>().norm() * way.norm());
        // The block is sheared before it slips.
        EXPECT_NEAR(result.state.frictionWork, way.norm() * mu * std::abs(force.z()),
                    0.1 * way.norm() * mu * std::abs(force.z()));
        EXPECT_LE(result.report.worst.friction, 1e-10);
        EXPECT_LE(result.report.worst.forceBalance, 1e-9);
      }
}

/// A soft block dragged in a curve over a table.
Model dragged() {
  const auto path = [](double t) {
    const double s = std::max(t - 0.25, 0.0) / 0.75;
    return SpacePoint(0.8 * s, 0.5 * s * s, -0.02 * std::min(4 * t, 1.0));
  };
  Body upper("upper", cuboidMesh({{0, 0, 0}, {1, 1, 1}, {3, 3, 2}}), elasticMaterial({100, 0.3}, Plane::none),
             {moved(top, path), {}, {}}, 1);
  Body lower("lower", cuboidMesh({{-1, -1, -1}, {3, 3, 0}, {8, 7, 2}}),
             elasticMaterial({200, 0.3}, Plane::none),
             {moved(bottom, [](double) { return SpacePoint(0, 0, 0); }), {}, {}}, 1);
  return following(std::move(upper), std::move(lower), CouplingKind::weighted, upperBody, 0.4, 0.5);
}

TEST(SlidingInSpace, energyIsKept) {
  expectEnergyKept(dragged(), 12);
}

TEST(SlidingInSpace, resumesToTheLastBit) {
  expectResumed(dragged(), dragged(), 6, 3);
}

// Held from above, a block leaves the table, and nothing presses.
TEST(SlidingInSpace, bodiesLeaveTheEnd) {
  Body upper("upper", cuboidMesh({{1, 0.3, 0}, {1.5, 0.8, 0.5}, {3, 3, 2}}),
             elasticMaterial({1e4, 0.3}, Plane::none),
             {moved(top,
                    [](double t) {
                      return SpacePoint(2 * std::max(t - 0.1, 0.0), 0, -1e-3 * std::min(10 * t, 1.0));
                    }),
              {},
              {}},
             1);
  Body lower("lower", cuboidMesh({{0, 0, -1}, {2, 1, 0}, {7, 4, 2}}),
             elasticMaterial({1e4, 0.3}, Plane::none),
             {moved(bottom, [](double) { return SpacePoint(0, 0, 0); }), {}, {}}, 1);
  const Model model =
      following(std::move(upper), std::move(lower), CouplingKind::weighted, upperBody, 0.2, 1);
  const Result left = run(model, 1, 16);
  ASSERT_EQ(left.report.status, Status::converged) << left.report.reason;
  EXPECT_TRUE(left.state.contactForce[0].isZero(0));
  EXPECT_GT(left.report.peaks.contactForce.value, 0);
}

}  // namespace mortier::sliding_in_space_test
