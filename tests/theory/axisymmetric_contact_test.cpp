// Patch tests of contact of bodies that turn about the axis x = 0.
#include <gtest/gtest.h>

#include <iostream>

#include "base/error.h"
#include "theory/axisymmetric.h"

namespace mortier::axisymmetric_contact_test {

using namespace scenes;

constexpr double reproduced = 1e-12;

void addAxisymmetric(Model& model, const ContactSide& nonmortar, const ContactSide& mortar,
                     const Rows& kind) {
  InterfaceOptions options;
  kind.set(options, 0.01);
  options.axisymmetric = true;
  addInterface(model, {nonmortar, mortar, kind}, options);
}

using Map = std::function<Point(const Point&)>;

struct Pair {
  const char* name;
  std::array<TriangleMesh, 2> meshes;
  std::array<ContactSide, 2> sides;
  std::array<std::vector<int>, 2> pressed;  ///< labels under the pressure
  std::array<int, 2> held;                  ///< labels whose motion along the axis is prescribed; 0 for none
};

/// All sides under the same pressure but those that are held: stress -p I, whatever the line of contact.
void expectHydrostatic(const Pair& pair, double& worst) {
  constexpr double pressure = 3;
  for (const Rows& kind : meanRows)
    for (const int degree : {1, 2})
      for (const int nonmortar : {0, 1}) {
        Model model;
        for (const int b : {0, 1}) {
          Conditions conditions;
          const Elasticity elasticity = b == 0 ? Elasticity{100, 0.3} : Elasticity{50, 0.4};
          // (1 - 2 nu)/E is the same, so are the displacements.
          const double strain = -pressure * (1 - 2 * elasticity.poisson) / elasticity.young;
          if (pair.held[b] != 0)
            conditions.displacements.push_back(
                {pair.held[b], alongY, [strain](double, double y, double t) { return strain * y * t; }});
          for (const int label : pair.pressed[b])
            conditions.tractions.push_back({label, alongNormal, constant(-pressure)});
          model.bodies.emplace_back(b == 0 ? "first" : "second", pair.meshes[b],
                                    elasticMaterial(elasticity, Plane::strain), conditions, degree, true);
        }
        addAxisymmetric(model, pair.sides[nonmortar], pair.sides[1 - nonmortar], kind);
        const auto [state, report] = run(model, 1, 1);
        ASSERT_EQ(report.status, Status::converged) << pair.name << ": " << report.reason;
        for (const BodyState& body : state.bodies)
          worst =
              std::max(worst, errorOfUniform(body.stress, ringStress(-pressure, -pressure, 0, -pressure)));
        const Vector p = model.interfaces[0].contactPressure(state.contactForce[0]);
        worst = std::max(worst, (p.array() / pressure - 1).abs().maxCoeff());
      }
}

/// Straight lines through the origin on y = 0, level ones on y = -1 and 1.
Map tilted(double slope) {
  return [slope](const Point& x) { return Point(x.x(), x.y() + slope * x.x() * (1 - std::abs(x.y()))); };
}

TriangleMesh mapped(TriangleMesh mesh, const Map& map) {
  for (Point& x : mesh.vertices) x = map(x);
  validate(mesh);
  return mesh;
}

TEST(AxisymmetricContact, patchOfRingsOnEachOther) {
  double worst = 0;
  for (const double inner : {0.0, 1.0})
    for (const double slope : {0.0, 0.25})  // flat, or cones
      expectHydrostatic({"stacked",
                         {mapped(shakenSection(inner, 2, 0, 1, 4, 1), tilted(slope)),
                          mapped(shakenSection(inner, 2, -1, 1, 7, 2), tilted(slope))},
                         {ContactSide{0, bottom}, ContactSide{1, top}},
                         {inner == 0 ? std::vector<int>{right, top} : std::vector<int>{left, right, top},
                          inner == 0 ? std::vector<int>{right} : std::vector<int>{left, right}},
                         {0, bottom}},
                        worst);
  std::cout << "rings on each other: error at most " << worst << "\n";
  EXPECT_LE(worst, reproduced);
}

TEST(AxisymmetricContact, patchOfRingsInEachOther) {
  double worst = 0;
  for (const double inner : {0.0, 1.0})
    expectHydrostatic(
        {"nested",
         {shakenSection(inner, 2, 0, 1, 4, 1), shakenSection(2, 3, 0, 1, 7, 2)},
         {ContactSide{0, right}, ContactSide{1, left}},
         {inner == 0 ? std::vector<int>{top} : std::vector<int>{left, top}, std::vector<int>{right, top}},
         {bottom, bottom}},
        worst);
  std::cout << "rings in each other: error at most " << worst << "\n";
  EXPECT_LE(worst, reproduced);
}

// Discs on each other under a uniaxial stress widen as they like: they slip.
TEST(AxisymmetricContact, patchUnderUniaxialStress) {
  double worst = 0;
  for (const Rows& kind : meanRows)
    for (const int nonmortar : {0, 1})
      for (const double inner : {0.0, 1.0}) {
        Model model;
        model.bodies.emplace_back("upper", shakenSection(inner, 2, 0, 1, 5, 1),
                                  elasticMaterial({100, 0.1}, Plane::strain),
                                  Conditions{{}, {{top, alongY, constant(-1)}}, {}}, 1, true);
        model.bodies.emplace_back("lower", shakenSection(inner, 2, -1, 1, 7, 2),
                                  elasticMaterial({300, 0.45}, Plane::strain),
                                  Conditions{{{bottom, alongY, constant(0)}}, {}, {}}, 1, true);
        const ContactSide sides[] = {{0, bottom}, {1, top}};
        addAxisymmetric(model, sides[nonmortar], sides[1 - nonmortar], kind);
        const auto [state, report] = run(model, 1, 1);
        ASSERT_EQ(report.status, Status::converged) << report.reason;
        for (const BodyState& body : state.bodies)
          worst = std::max(worst, errorOfUniform(body.stress, ringStress(0, -1, 0, 0)));
        const double area = pi * (4 - inner * inner);
        EXPECT_NEAR(state.contactForce[0].sum(), area, 1e-12 * area);
        const double line = model.interfaces[0].lengths().sum();
        EXPECT_NEAR(line, 2 - inner, 0.06);  // the wider disc reaches over the other
      }
  std::cout << "discs under a uniaxial stress: error at most " << worst << "\n";
  EXPECT_LE(worst, reproduced);
}

}  // namespace mortier::axisymmetric_contact_test
