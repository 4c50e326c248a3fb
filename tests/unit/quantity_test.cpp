// Forces of supports and of contact, and displacements, as a user asks for them.
#include "time/quantity.h"

#include <gtest/gtest.h>

#include <cmath>

#include "material/perzyna.h"
#include "mesh/generate.h"
#include "time/march.h"
#include "time/mean_pressure.h"

namespace mortier::quantity_test {

using Kind = Quantity::Kind;
using Component = Quantity::Component;

Function constant(double value) {
  return [value](double, double, double) { return value; };
}

/// A block of 2 by 1 on rollers along its base and its left side, under a pressure on top that grows to the
/// right and a shear on its right side, with a body force.
Model loadedBlock() {
  Conditions conditions;
  conditions.displacements = {{1, alongY, constant(0)}, {4, alongX, constant(0)}};
  conditions.tractions = {{3, alongY, [](double x, double, double t) { return -(1 + x) * t; }},
                          {2, alongX, constant(0.5)}};
  conditions.forces = {{1, constant(-0.25)}};
  Model model;
  model.bodies.emplace_back("block", crissCrossMesh({{0, 0}, {2, 1}, 5, 3}), elasticMaterial({100, 0.3}),
                            conditions);
  return model;
}

State solved(const Model& model) {
  State state = initialState(model);
  TimePlan plan;
  plan.end = 1;
  plan.steps = 1;
  march(model, state, plan, {}, [](const State&, const StepReport&) {});
  return state;
}

// The loads sum to 0.5 along x and to -(2 + 2) - 0.25*2 along y. About the origin, those along y turn by
// -(2 + 8/3) - 0.25*2*1 and the shear by -0.5*0.5.
TEST(Quantity, reactionsBalanceLoads) {
  const Model model = loadedBlock();
  const State state = solved(model);
  std::vector<Quantity> quantities;
  for (const int label : {1, 4})
    for (const Component component : {Component::x, Component::y, Component::momentZ})
      quantities.push_back({"r", Kind::reaction, 0, label, component, {0, 0}});
  const std::vector<double> r = evaluate(quantities, model, state);
  EXPECT_EQ(r[0], 0) << "a roller along the base holds nothing along it";
  EXPECT_EQ(r[4], 0);
  EXPECT_NEAR(r[1], 4.5, 1e-12);
  EXPECT_NEAR(r[3], -0.5, 1e-13);
  EXPECT_NEAR(r[2] + r[5], 2 + 8.0 / 3 + 0.5 + 0.25, 1e-12);
  // Seen from another point the moment changes by the force.
  const Quantity moved{"m", Kind::reaction, 0, 1, Component::momentZ, {0.75, 3, 0}};
  EXPECT_NEAR(evaluate({moved}, model, state)[0], r[2] - 0.75 * r[1], 1e-12);
  EXPECT_EQ(quantities[2].unit(), "N");
  EXPECT_EQ(quantities[0].unit(), "N/m");
}

// A corner of two rollers at an angle of 60 degrees: each reacts along its own normal, and together they hold
// the load.
TEST(Quantity, aCornerReactsAlongTheNormalsOfItsSides) {
  const double c = 0.5;
  const double s = std::sqrt(0.75);
  Conditions conditions;
  conditions.displacements = {{1, alongNormal, constant(0)}, {4, alongNormal, constant(0)}};
  conditions.tractions = {{2, alongX, constant(-1)}, {3, alongY, constant(-2)}};
  Model model;
  Quadrilateral shape{{Point(0, 0), Point(2, 0), Point(2 + 2 * c, 2 * s), Point(2 * c, 2 * s)}, 4, 4};
  model.bodies.emplace_back("wedge", quadrilateralMesh(shape, Cut::both), elasticMaterial({100, 0.3}),
                            conditions);
  const State state = solved(model);
  const auto value = [&](int label, Component component) {
    return evaluate({{"r", Kind::reaction, 0, label, component, {0, 0}}}, model, state)[0];
  };
  EXPECT_NEAR(value(1, Component::x), 0, 1e-13);
  EXPECT_NEAR(value(4, Component::y) / value(4, Component::x), -c / s, 1e-12);
  EXPECT_NEAR(value(1, Component::x) + value(4, Component::x), 2, 1e-12);
  EXPECT_NEAR(value(1, Component::y) + value(4, Component::y), 4, 1e-12);
}

// Meshes that do not match: what one block gets from the other is what its supports take.
TEST(Quantity, contactForcesPassThroughABody) {
  Model model;
  const auto add = [&](const char* name, Rectangle shape, Conditions conditions) {
    model.bodies.emplace_back(name, crissCrossMesh(shape), elasticMaterial({100, 0.3}),
                              std::move(conditions));
  };
  Conditions pressed;
  pressed.displacements = {{4, alongX, constant(0)}};
  pressed.tractions = {{3, alongY, [](double x, double, double) { return -1 - x; }}};
  Conditions held;
  held.displacements = {{1, alongX, constant(0)}, {1, alongY, constant(0)}};
  add("upper", {{0, 0}, {1, 1}, 3, 3}, pressed);
  add("lower", {{0, -1}, {1, 0}, 4, 4}, held);
  addInterface(model, {{0, 1}, {1, 3}, CouplingKind::mortar});
  const State state = solved(model);
  const auto value = [&](Kind kind, int body, int label, Component component) {
    return evaluate({{"q", kind, body, label, component, {0, 0}}}, model, state)[0];
  };
  EXPECT_NEAR(value(Kind::contactForce, 0, 1, Component::y), 1.5, 1e-12);
  EXPECT_NEAR(value(Kind::contactForce, 1, 3, Component::y), -1.5, 1e-12);
  EXPECT_NEAR(value(Kind::contactForce, 0, 1, Component::momentZ),
              -value(Kind::contactForce, 1, 3, Component::momentZ), 1e-12);
  EXPECT_NEAR(value(Kind::reaction, 1, 1, Component::y), 1.5, 1e-12);
  EXPECT_NEAR(value(Kind::reaction, 1, 1, Component::momentZ),
              -value(Kind::contactForce, 1, 3, Component::momentZ), 1e-12);
}

// Blocks that are held sideways: the pressure of contact is that of the load.
TEST(Quantity, ofContactAndTheLargestStress) {
  Model model;
  Conditions pressed;
  pressed.displacements = {{4, alongX, constant(0)}, {2, alongX, constant(0)}};
  pressed.tractions = {{3, alongY, [](double, double, double t) { return -2 * t; }}};
  Conditions held = pressed;
  held.tractions.clear();
  held.displacements.push_back({1, alongY, constant(0)});
  model.bodies.emplace_back("upper", crissCrossMesh({{0, 0}, {3, 1}, 3, 1}), elasticMaterial({100, 0}),
                            pressed);
  model.bodies.emplace_back("lower", crissCrossMesh({{0, -1}, {3, 0}, 5, 1}), elasticMaterial({100, 0}),
                            held);
  addInterface(model, {{0, 1}, {1, 3}, CouplingKind::mortar});
  const State state = solved(model);
  const Quantity pressure{"p", Kind::largestPressure, 1, 3};
  const Quantity length{"l", Kind::contactLength, 0, 1};
  const Quantity mises{"m", Kind::largestMises, 1};
  const std::vector<double> values = evaluate({pressure, length, mises}, model, state);
  EXPECT_NEAR(values[0], 2, 1e-12);
  EXPECT_NEAR(values[1], 3, 1e-12);
  EXPECT_NEAR(values[2], 2, 1e-12);
  EXPECT_NEAR(placeOf(pressure, model, state)->y(), 0, 1e-15);
  const Point place = placeOf(mises, model, state)->head<2>();
  EXPECT_TRUE(place.x() > 0 && place.x() < 3 && place.y() > -1 && place.y() < 0);
  EXPECT_EQ(pressure.unit(), "Pa");
  EXPECT_EQ(length.unit(Units::from("mm, N, MPa")), "mm");
  // With one node alone in contact: the length that its row function covers.
  State touching = state;
  touching.contactForce[0].setZero();
  EXPECT_EQ(evaluate({pressure, length}, model, touching), (std::vector<double>{0, 0}));
  EXPECT_FALSE(placeOf(pressure, model, touching));
  touching.contactForce[0][1] = 1;
  EXPECT_NEAR(evaluate({length}, model, touching)[0], 1, 1e-12);
  EXPECT_GT(evaluate({pressure}, model, touching)[0], 1);
}

// The range of a run has the initial state in it, and when the extremes came first.
TEST(Quantity, rangesAreThoseOfTheRun) {
  Conditions conditions;
  conditions.displacements = {{1, alongY, constant(0)}, {4, alongX, constant(0)}};
  conditions.tractions = {{3, alongY, [](double, double, double t) { return 1 - (t - 1) * (t - 1); }}};
  Model model;
  model.bodies.emplace_back("block", crissCrossMesh({{0, 0}, {1, 1}, 2, 2}), elasticMaterial({100, 0.3}),
                            conditions);
  State state = initialState(model);
  const TimePlan plan{
      .end = 3,
      .steps = 6,
      .quantities = {{"r", Kind::reaction, 0, 1, Component::y}, {"e", Kind::storedEnergy, 0}}};
  std::vector<std::vector<double>> seen;
  const RunReport report = march(model, state, plan, {}, [&](const State& now, const StepReport& step) {
    seen.push_back(step.quantities);
    EXPECT_EQ(step.quantities, evaluate(plan.quantities, model, now));
  });
  ASSERT_EQ(seen.size(), 7);
  const QuantityRange& force = report.quantities[0];
  EXPECT_EQ(force.start, 0);
  EXPECT_NEAR(force.smallest, -1, 1e-13);
  EXPECT_EQ(force.smallestTime, 1);
  EXPECT_NEAR(force.largest, 3, 1e-12);
  EXPECT_EQ(force.largestTime, 3);
  EXPECT_EQ(report.quantities[1].smallestTime, 0);
}

// Weights reproduce linear fields: at a point, and in the mean over a label with edges of any length.
TEST(Quantity, displacementsAreThoseOfThePoint) {
  TriangleMesh mesh = rectangleMesh({{0, 0}, {2, 1}, 5, 3, Point(0, 0), {3, 2}}, Cut::rising);
  const auto mean = [&](const std::vector<std::pair<int, double>>& weights) {
    Point p = Point::Zero();
    for (const auto& [v, weight] : weights) p += weight * mesh.vertices[v];
    return p;
  };
  for (const Point& p : {Point(0.3, 0.7), Point(0, 0), Point(2, 1), Point(1.1, 0), Point(2, 0.123)})
    EXPECT_LT((mean(meanAt(mesh, elementNodes(mesh, 1), p)) - p).norm(), 1e-14);
  EXPECT_TRUE(meanAt(mesh, elementNodes(mesh, 1), {2.001, 0.5}).empty());
  EXPECT_LT((mean(meanOn(mesh, elementNodes(mesh, 1), 1)) - Point(1, 0)).norm(), 1e-14);
  EXPECT_LT((mean(meanOn(mesh, elementNodes(mesh, 1), 2)) - Point(2, 0.5)).norm(), 1e-14);
}

// Quadratic fields too where displacements are quadratic, on straight and on curved sides.
TEST(Quantity, quadraticDisplacementsAreThoseOfThePoint) {
  TriangleMesh mesh = rectangleMesh({{0, 0}, {2, 1}, 5, 3, Point(0, 0), {3, 2}}, Cut::rising);
  const ElementNodes nodes = elementNodes(mesh, 2);
  const auto mean = [&](const std::vector<std::pair<int, double>>& weights, auto field) {
    double sum = 0;
    for (const auto& [node, weight] : weights) sum += weight * field(nodes.places[node]);
    return sum;
  };
  const auto square = [](const Point& x) { return x.x() * x.x() - x.x() * x.y(); };
  constexpr double rounding = 1e-13;
  for (const Point& p : {Point(0.3, 0.7), Point(0, 0), Point(2, 1), Point(1.1, 0), Point(2, 0.123)})
    EXPECT_NEAR(mean(meanAt(mesh, nodes, p), square), square(p), rounding);
  // Of x^2 along y = 0 the mean is 4/3; over the ring, weighted by x, 2.
  EXPECT_NEAR(mean(meanOn(mesh, nodes, 1), square), 4.0 / 3, rounding);
  EXPECT_NEAR(mean(meanOn(mesh, nodes, 1, true), square), 2, rounding);
}

TEST(Quantity, meanOnACurveIsByItsLength) {
  // A quarter of a circle by one triangle with a curved side: x has the mean 2/pi, up to the parabola.
  TriangleMesh mesh;
  mesh.vertices = {{0, 0}, {1, 0}, {0, 1}};
  mesh.triangles = {{0, 1, 2}};
  mesh.regions = {0};
  mesh.boundaryEdges = {{1, 2}};
  mesh.boundaryLabels = {1};
  mesh.edgeMiddles = {Point(std::sqrt(0.5), std::sqrt(0.5))};
  const ElementNodes nodes = elementNodes(mesh, 2);
  const std::vector<std::pair<int, double>> weights = meanOn(mesh, nodes, 1);
  double x = 0;
  for (const auto& [node, weight] : weights) x += weight * nodes.places[node].x();
  EXPECT_NEAR(x, 2 / M_PI, 0.005);
  // The point is found on the curved triangle.
  Point found = Point::Zero();
  for (const auto& [node, weight] : meanAt(mesh, nodes, {0.5, 0.4999})) found += weight * nodes.places[node];
  EXPECT_LT((found - Point(0.5, 0.4999)).norm(), 1e-12);
}

// Two triangles that meet on a quarter of a circle: the mean of a pressure of 1 is 1, over the curve and not
// over the chord.
TEST(Quantity, meanPressureOnACurveIsByItsLength) {
  Model model;
  for (const double far : {0.0, 2.0}) {
    TriangleMesh mesh;
    mesh.vertices = {{far, far}, {1, 0}, {0, 1}};
    mesh.triangles = {far == 0 ? std::array{0, 1, 2} : std::array{0, 2, 1}};
    mesh.regions = {0};
    mesh.boundaryEdges = {far == 0 ? std::array{1, 2} : std::array{2, 1}};
    mesh.boundaryLabels = {1};
    mesh.edgeMiddles = {Point(std::sqrt(0.5), std::sqrt(0.5))};
    model.bodies.emplace_back(far == 0 ? "disc" : "round it", mesh, elasticMaterial({1, 0}), Conditions{}, 2);
  }
  addInterface(model, {{0, 1}, {1, 1}, CouplingKind::weighted});
  const Vector force = model.interfaces[0].mass() * Vector::Ones(model.interfaces[0].rows());
  EXPECT_NEAR(force.sum(), M_PI / 2, 0.01);
  const LinePart whole(boundaryLine(model.bodies[0].mesh(), 1));
  EXPECT_NEAR(meanPressureShares(model, 0, 1, whole)[0].dot(force), 1, 0.005);
}

}  // namespace mortier::quantity_test
