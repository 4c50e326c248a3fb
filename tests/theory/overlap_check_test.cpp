// Bodies that overlap where no contact holds them apart: the step is refused, whatever its residuals are.
#include "time/overlap_check.h"

#include <gtest/gtest.h>

#include <cmath>

#include "material/elasticity.h"
#include "theory/scenes.h"

namespace mortier::overlap_check_test {

using namespace scenes;

constexpr double residual = 1e-8;

Function down(double by) {
  return [by](double, double, double t) { return -by * t; };
}

/// A block pressed onto another one by `by`.
Model pressed(double by, CouplingKind coupling = CouplingKind::mortar, InterfaceOptions options = {}) {
  Body upper("upper", square(0, 5), elasticMaterial({100, 0.3}),
             {{{left, 0, constant(0)}, {top, 1, down(by)}}, {}, {}});
  Body lower("lower", square(-1, 7), elasticMaterial({100, 0.3}),
             {{{left, 0, constant(0)}, {bottom, 1, constant(0)}}, {}, {}});
  return contactModel(std::move(upper), std::move(lower), coupling, upperBody, std::move(options));
}

/// The upper block moved as a whole.
std::vector<Vector> movedBy(const Model& model, const Point& by) {
  std::vector<Vector> u;
  for (const Body& body : model.bodies) u.push_back(Vector::Zero(body.dofs()));
  for (Eigen::Index i = 0; i < u[upperBody].size(); i += 2) u[upperBody].segment<2>(i) = by;
  return u;
}

std::vector<Vector> forces(const Model& model, double value) {
  return {Vector::Constant(model.interfaces[0].rows(), value)};
}

TEST(OverlapCheck, acceptsContactThatHoldsBodiesApart) {
  for (const Rows& coupling : meanRows) {
    InterfaceOptions options;
    coupling.set(options, 0.01);
    const Result result = run(pressed(0.02, coupling, options), 1, 2);
    EXPECT_EQ(result.report.status, Status::converged) << result.report.reason;
    EXPECT_TRUE(result.report.overlap.explained);
    EXPECT_LE(result.report.overlap.depth, 1e-8);
  }
}

// All rows of contact are removed: the blocks pass through each other, and every residual is rounding.
TEST(OverlapCheck, refusesAStepWhoseRowsAreRemoved) {
  Model model = pressed(0.2);  // an element deep
  model.interfaces.clear();
  const Result result = run(model, 1, 2);
  EXPECT_EQ(result.report.status, Status::failed);
  EXPECT_EQ(result.report.steps, 0);
  EXPECT_FALSE(result.report.overlap.explained);
  EXPECT_NE(result.report.reason.find("overlap by"), std::string::npos) << result.report.reason;
  EXPECT_NE(result.report.reason.find("no [[contact]] names label"), std::string::npos)
      << result.report.reason;
}

// The contact is of another side than the one that comes down onto it.
TEST(OverlapCheck, refusesAStepWithTheWrongLabel) {
  Model model = pressed(0.02);
  TriangleMesh plate = rectangleMesh({{0.2, 1.005}, {0.8, 1.5}, 3, 2});
  model.bodies.emplace_back("plate", std::move(plate), elasticMaterial({100, 0.3}),
                            Conditions{{{top, 0, constant(0)}, {top, 1, down(0.2)}}, {}, {}});
  const Result result = run(model, 1, 4);
  EXPECT_EQ(result.report.status, Status::failed);
  EXPECT_NE(result.report.reason.find("of plate"), std::string::npos) << result.report.reason;
  EXPECT_NE(result.report.reason.find("of upper"), std::string::npos) << result.report.reason;
}

// Rows that are there and do not press explain nothing, nor do rows that press far away.
TEST(OverlapCheck, isExplainedByRowsThatPressNearbyOnly) {
  const Model model = pressed(0.02);
  const OverlapCheck check(model);
  for (const double by : {1e-6, 1e-3, 0.1}) {
    const std::vector<Vector> u = movedBy(model, {0, -by});
    const BodyOverlap found = check.find(u, forces(model, 0), 1, residual);
    EXPECT_FALSE(found.explained);
    EXPECT_NEAR(found.depth, by, 1e-12);
    EXPECT_NE(found.words.find("no contact presses there"), std::string::npos) << found.words;
    // Flat blocks in contact have no error between their nodes.
    EXPECT_FALSE(check.find(u, forces(model, 1), 1, residual).explained);
  }
  EXPECT_TRUE(check.find(movedBy(model, {0, 1e-3}), forces(model, 0), 1, residual).explained);
  EXPECT_TRUE(check.find(movedBy(model, {0, -1e-9}), forces(model, 0), 1, residual).explained);
}

// A distance that is given is one that bodies overlap by.
TEST(OverlapCheck, acceptsADistanceThatIsGiven) {
  InterfaceOptions options;
  options.gap = still([](const Point&) { return 0.01; });
  Model model = pressed(0.02, CouplingKind::mortar, options);
  const OverlapCheck check(model);
  EXPECT_TRUE(check.find(movedBy(model, {0, -0.0099}), forces(model, 0), 1, residual).explained);
  EXPECT_FALSE(check.find(movedBy(model, {0, -0.0102}), forces(model, 0), 1, residual).explained);
}

}  // namespace mortier::overlap_check_test
