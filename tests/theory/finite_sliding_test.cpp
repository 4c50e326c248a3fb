// Contact that follows the bodies: the patch test moved far, full slip along a table, order in the step,
// energy.
#include <gtest/gtest.h>

#include <cmath>

#include "material/elasticity.h"
#include "theory/sliding_bodies.h"

namespace mortier::finite_sliding_test {

using namespace scenes;

constexpr double mu = 0.3;

TriangleMesh turned(TriangleMesh mesh, double angle) {
  const Eigen::Matrix2d rotation{{std::cos(angle), -std::sin(angle)}, {std::sin(angle), std::cos(angle)}};
  for (Point& x : mesh.vertices) x = rotation * x;
  return mesh;
}

// Blocks of different meshes under uniform pressure, turned, and moved together by ten widths: whatever it
// was, the pressure stays constant.
TEST(FiniteSliding, patchIsExactWhereverItMoves) {
  constexpr double p = 2;
  constexpr double angle = 0.4;
  const Point n(-std::sin(angle), std::cos(angle));
  const Point way = 10 * Point(n.y(), -n.x()) + 3 * n;
  for (const Rows& coupling : meanRows)
    for (const int degree : {1, 2})
      for (const int nonmortar : {upperBody, lowerBody}) {
        const auto at = [](double first, double then) {  // pressed at once, then moved
          return Function([=](double, double, double t) {
            return first * std::min(2 * t, 1.0) + then * std::max(2 * t - 1, 0.0);
          });
        };
        const double soft = 100;
        const double hard = 300;
        const Point down = -p * (1 / soft + 1 / hard) * n;
        Body upper("upper", turned(square(0, 5), angle), elasticMaterial({soft, 0}),
                   {{{top, 0, at(down.x(), way.x())}, {top, 1, at(down.y(), way.y())}}, {}, {}}, degree);
        Body lower("lower", turned(square(-1, 7), angle), elasticMaterial({hard, 0}),
                   {{{bottom, 0, at(0, way.x())}, {bottom, 1, at(0, way.y())}}, {}, {}}, degree);
        const Model model = following(std::move(upper), std::move(lower), coupling, nonmortar, mu,
                                      nonmortar == upperBody ? soft / hard : hard / soft);
        const Result result = run(model, 1, 10);
        ASSERT_EQ(result.report.status, Status::converged) << result.report.reason;
        Vector pressure = model.interfaces[0].contactPressure(result.state.contactForce[0]);
        for (int row = 0; row < model.interfaces[0].rows(); ++row)
          if (model.interfaces[0].faces(row)) {
            EXPECT_NEAR(pressure[row], p, 1e-10 * p);
          }
        EXPECT_LE(result.report.worst.forceBalance, 1e-11);
        EXPECT_LE(result.report.worst.gapOnActive, 1e-12);
      }
}

/// A block pressed onto a stiff table, ten times as wide, and pushed along it by `way`.
Model pushed(CouplingKind coupling, int nonmortar, double way, double friction = mu, int degree = 1) {
  const auto across = [](double, double, double t) { return -0.02 * std::min(4 * t, 1.0); };
  const auto along = [way](double, double, double t) { return way * std::max(t - 0.25, 0.0) / 0.75; };
  Body upper("upper", crissCrossMesh({.lower = {0, 0}, .upper = {1, 1}, .cellsX = 5, .cellsY = 5}),
             elasticMaterial({100, 0.3}), {{{top, 0, along}, {top, 1, across}}, {}, {}}, degree);
  Body lower("lower", crissCrossMesh({.lower = {-1, -1}, .upper = {12, 0}, .cellsX = 41, .cellsY = 2}),
             elasticMaterial({1e14, 0.3}), {{{bottom, 0, constant(0)}, {bottom, 1, constant(0)}}, {}, {}},
             degree);
  return following(std::move(upper), std::move(lower), coupling, nonmortar, friction,
                   nonmortar == upperBody ? 1e-12 : 1e12);
}

TEST(FiniteSliding, forceOfFullSlipIsThatOfCoulomb) {
  for (const CouplingKind coupling : {CouplingKind::mortar, CouplingKind::weighted})
    for (const int degree : {1, 2})
      for (const int nonmortar : {upperBody, lowerBody}) {
        const Model model = pushed(coupling, nonmortar, 10, mu, degree);
        const Result result = run(model, 1, 20);
        ASSERT_EQ(result.report.status, Status::converged) << result.report.reason;
        const Point force = resultant(model, result.state, 0).head<2>();
        EXPECT_NEAR(std::abs(force.x() / force.y()), mu, 1e-10) << nameOf(coupling) << degree << nonmortar;
        EXPECT_NEAR(result.state.frictionWork, 10 * mu * std::abs(force.y()),
                    0.05 * 10 * mu * std::abs(force.y()));
        EXPECT_LE(result.report.worst.friction, 1e-10);
        EXPECT_LE(result.report.worst.forceBalance, 1e-9);
      }
}

double across(double t) {
  return -0.02 * std::min(4 * t, 1.0);
}
double along(double t) {
  const double s = std::max(t - 0.25, 0.0) / 0.75;
  return 0.8 * s * s;
}

/// A soft block dragged faster and faster over a softer table than the one above, with friction.
Model dragged() {
  const auto at = [](double (*path)(double)) {
    return Function([path](double, double, double t) { return path(t); });
  };
  Body upper("upper", crissCrossMesh({.lower = {0, 0}, .upper = {1, 1}, .cellsX = 5, .cellsY = 5}),
             elasticMaterial({100, 0.3}), {{{top, 0, at(along)}, {top, 1, at(across)}}, {}, {}});
  Body lower("lower", crissCrossMesh({.lower = {-1, -1}, .upper = {3, 0}, .cellsX = 13, .cellsY = 3}),
             elasticMaterial({200, 0.3}), {{{bottom, 0, constant(0)}, {bottom, 1, constant(0)}}, {}, {}});
  return following(std::move(upper), std::move(lower), CouplingKind::weighted, upperBody, 0.4, 0.5);
}

// In full slip the end does not depend on the way; what friction dissipates on it is of second order.
TEST(FiniteSliding, isOfSecondOrderInTheStep) {
  std::vector<Result> results;
  for (const int steps : {32, 64, 128}) {
    results.push_back(run(dragged(), 1, steps));
    ASSERT_EQ(results.back().report.status, Status::converged) << results.back().report.reason;
  }
  const auto work = [&](int i) { return results[i].state.frictionWork; };
  EXPECT_GE((work(1) - work(0)) / (work(2) - work(1)), 3);
  EXPECT_LE(std::abs(work(2) - work(1)), 2e-4 * work(2));
  const auto& end = results[1].state.bodies[upperBody].displacement;
  EXPECT_LE((results[0].state.bodies[upperBody].displacement - end).norm(), 1e-9 * end.norm());
}

TEST(FiniteSliding, energyIsKept) {
  expectEnergyKept(dragged(), 20);
}

TEST(FiniteSliding, resumesToTheLastBit) {
  expectResumed(dragged(), dragged(), 12, 7);
}

// Pushed by a force over the end of a table, a block falls; held from above it leaves, and nothing presses.
TEST(FiniteSliding, bodiesLeaveTheEnd) {
  const auto along = [](double, double, double t) { return 2 * std::max(t - 0.1, 0.0); };
  const auto block = [&](bool held) {
    std::vector<Condition> supports{{top, 0, along}};
    std::vector<Condition> loads;
    const auto down = [held](double, double, double t) {
      return held ? -1e-3 * std::min(10 * t, 1.0) : -std::min(10 * t, 1.0);
    };
    if (held)
      supports.push_back({top, 1, down});
    else
      loads.push_back({top, 1, down});
    Body upper("upper", crissCrossMesh({.lower = {1, 0}, .upper = {1.5, 0.5}, .cellsX = 4, .cellsY = 4}),
               elasticMaterial({1e4, 0.3}), {supports, loads, {}});
    Body lower("lower", crissCrossMesh({.lower = {0, -1}, .upper = {2, 0}, .cellsX = 9, .cellsY = 3}),
               elasticMaterial({1e4, 0.3}), {{{bottom, 0, constant(0)}, {bottom, 1, constant(0)}}, {}, {}});
    return following(std::move(upper), std::move(lower), CouplingKind::weighted, upperBody, held ? 0.2 : 0,
                     1);
  };
  const Result left = run(block(true), 1, 20);
  ASSERT_EQ(left.report.status, Status::converged) << left.report.reason;
  EXPECT_TRUE(left.state.contactForce[0].isZero(0));
  EXPECT_GT(left.report.peaks.contactForce.value, 0);
  const Result fallen = run(block(false), 1, 20);
  EXPECT_EQ(fallen.report.status, Status::unheld);
  EXPECT_NE(fallen.report.reason.find("body upper"), std::string::npos) << fallen.report.reason;
  EXPECT_GE(fallen.state.time, 0.4);
  EXPECT_LT(fallen.state.time, 0.6);  // its centre passes the end at t = 0.475
}

}  // namespace mortier::finite_sliding_test
