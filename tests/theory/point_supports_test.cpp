// A body whose loads balance each other has one stress, whatever takes its rigid motions away: three motions
// at any two vertices, or labels that move with the exact solution.
#include <gtest/gtest.h>

#include <Eigen/QR>

#include "material/perzyna.h"
#include "mesh/generate.h"
#include "time/march.h"

namespace mortier::point_supports_test {

using Supports = std::vector<Condition>;

Function constant(double value) {
  return [value](double, double, double) { return value; };
}

Supports heldAt(const Point& pinned, const Point& guided, int component) {
  return {{0, alongX, constant(0), asSpacePoint(pinned)},
          {0, alongY, constant(0), asSpacePoint(pinned)},
          {0, component, constant(0), asSpacePoint(guided)}};
}

/// A rectangle of 2 by 1 in pure shear s12 = 6, and bent by a moment where `bent`.
State solved(const Supports& supports, int degree, bool bent) {
  Conditions conditions;
  conditions.displacements = supports;
  conditions.tractions = {{1, alongX, constant(-6)},
                          {3, alongX, constant(6)},
                          {2, alongY, constant(6)},
                          {4, alongY, constant(-6)}};
  if (bent)
    for (const int side : {2, 4})
      conditions.tractions.push_back(
          {side, alongNormal, [](double, double y, double) { return 3 * (y - 0.5); }});
  Model model;
  model.bodies.emplace_back("block", crissCrossMesh({{0, 0}, {2, 1}, 4, 2}), elasticMaterial({100, 0.25}),
                            conditions, degree);
  State state = initialState(model);
  TimePlan plan;
  plan.end = 1;
  plan.steps = 1;
  EXPECT_EQ(march(model, state, plan, {}, [](const State&, const StepReport&) {}).status, Status::converged);
  return state;
}

/// What is left of a displacement beside the nearest rigid motion.
double deformation(const Vector& u, int degree) {
  const std::vector<Point> places = elementNodes(crissCrossMesh({{0, 0}, {2, 1}, 4, 2}), degree).places;
  Matrix motions(u.size(), 3);
  for (size_t i = 0; i < places.size(); ++i)
    motions.middleRows<2>(2 * static_cast<Eigen::Index>(i)) << 1, 0, -places[i].y(), 0, 1, places[i].x();
  return (u - motions * motions.colPivHouseholderQr().solve(u)).lpNorm<Eigen::Infinity>();
}

TEST(PointSupports, allThatHoldABalancedBodyGiveTheSameStress) {
  constexpr double rounding = 1e-12;
  for (const int degree : {1, 2})
    for (const bool bent : {false, true}) {
      const State one = solved(heldAt({0, 0}, {2, 0}, alongY), degree, bent);
      const State two = solved(heldAt({2, 1}, {2, 0.5}, alongX), degree, bent);
      EXPECT_LE((one.bodies[0].stress - two.bodies[0].stress).lpNorm<Eigen::Infinity>(), 6 * rounding);
      EXPECT_LE(deformation(one.bodies[0].displacement - two.bodies[0].displacement, degree), rounding);
      EXPECT_GT((one.bodies[0].displacement - two.bodies[0].displacement).lpNorm<Eigen::Infinity>(), 1e-3);
    }
}

// u1 = 2 e12 y t with e12 = s12 (1 + nu)/E.
TEST(PointSupports, andSoDoLabelsThatMoveWithTheSolution) {
  constexpr double rounding = 1e-12;
  const Supports labels{{1, alongX, constant(0)},
                        {1, alongY, constant(0)},
                        {4, alongX, [](double, double y, double t) { return 2 * 6 * 1.25 / 100 * y * t; }}};
  for (const int degree : {1, 2}) {
    const State one = solved(heldAt({0, 0}, {2, 0}, alongY), degree, false);
    const State two = solved(labels, degree, false);
    EXPECT_LE((one.bodies[0].stress - two.bodies[0].stress).lpNorm<Eigen::Infinity>(), 6 * rounding);
    EXPECT_LE((one.bodies[0].displacement - two.bodies[0].displacement).lpNorm<Eigen::Infinity>(), rounding);
  }
}

}  // namespace mortier::point_supports_test
