// Contact of bodies that turn about the axis x = 0: patch tests, a sphere on a plane (Hertz), a flat punch
// (Boussinesq).
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

/// In proportion to time: what is prescribed at t = 0 strains nothing.
Function growing(double value) {
  return [value](double, double, double t) { return value * t; };
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

/// What Hertz's theory says of a contact force F: p^2 = p0^2 (1 - r^2/a^2).
struct Hertz {
  double peak = 0;
  double radius = 0;
};

/// p^2 fitted by a linear function of r^2, without the nodes next to the end.
Hertz fitted(const std::vector<std::pair<double, double>>& squares) {
  double x = 0;
  double y = 0;
  double xx = 0;
  double xy = 0;
  const auto n = static_cast<double>(squares.size());
  for (const auto& [r2, p2] : squares) {
    x += r2 / n;
    y += p2 / n;
  }
  for (const auto& [r2, p2] : squares) {
    xx += (r2 - x) * (r2 - x);
    xy += (r2 - x) * (p2 - y);
  }
  const double slope = xy / xx;
  const double atAxis = y - slope * x;
  return {std::sqrt(atAxis), std::sqrt(-atAxis / slope)};
}

// A sphere of radius 1 on a block 1.5 wide, pressed so that a = 0.04.
TEST(AxisymmetricContact, hertz) {
  constexpr Elasticity ball{2.1e5, 0.3};
  constexpr Elasticity plate{7e4, 0.33};
  constexpr double compliance = (1 - 0.3 * 0.3) / 2.1e5 + (1 - 0.33 * 0.33) / 7e4;
  for (const int degree : {1, 2})
    for (const int nonmortar : {0, 1}) {
      Model model;
      const int cells = degree == 1 ? 40 : 20;
      const double indent = 0.04 * 0.04 * 1.02;
      model.bodies.emplace_back("ball", halfDiscMesh({{0, 0}, 1, 0.06, cells, true}),
                                elasticMaterial(ball, Plane::strain),
                                Conditions{{{2, alongY, growing(-indent)}}, {}, {}}, degree, true);
      model.bodies.emplace_back("plate",
                                rectangleMesh({.lower = {0, -1.5},
                                               .upper = {1.5, 0},
                                               .cellsX = 2 * cells + 9,
                                               .cellsY = 2 * cells + 9,
                                               .focus = Point(0, 0),
                                               .grading = {60, 60}},
                                              Cut::both),
                                elasticMaterial(plate, Plane::strain),
                                Conditions{{{bottom, alongY, constant(0)}}, {}, {}}, degree, true);
      const ContactSide sides[] = {{0, 1}, {1, top}};
      addAxisymmetric(model, sides[nonmortar], sides[1 - nonmortar], CouplingKind::mortar);
      const auto [state, report] = run(model, 1, 1);
      ASSERT_EQ(report.status, Status::converged) << report.reason;
      const ContactInterface& interface = model.interfaces[0];
      const Body& carrier = model.bodies[interface.pair().nonmortar.body];
      const Vector& p = state.contactForce[0];
      const Vector pressure = interface.contactPressure(p);
      const double force = p.dot(Vector::Ones(p.size()));
      const double exactRadius = std::cbrt(0.75 * force * compliance);
      const double exactPeak = 1.5 * force / (pi * exactRadius * exactRadius);
      std::vector<std::pair<double, double>> squares;
      for (Eigen::Index i = 0; i < p.size(); ++i) {
        const double r = carrier.elementNodes().places[interface.nonmortarNodes()[i]].x();
        if (p[i] > 0 && r < 0.7 * exactRadius) squares.emplace_back(r * r, pressure[i] * pressure[i]);
      }
      const Hertz found = fitted(squares);
      std::cout << "sphere on a plane, degree " << degree << ", nonmortar " << carrier.name() << ": a "
                << exactRadius << ", " << squares.size() << " nodes, peak pressure "
                << pressure.maxCoeff() / exactPeak << ", fitted peak " << found.peak / exactPeak
                << ", radius " << found.radius / exactRadius << " of Hertz's\n";
      EXPECT_NEAR(pressure.maxCoeff() / exactPeak, 1, 0.01);
      EXPECT_NEAR(found.radius / exactRadius, 1, 0.01);
    }
}

// A stiff flat punch of radius 1 on a half space: p = F/(2 pi a sqrt(a^2 - r^2)), F = 2 a d E/(1 - nu^2) for
// the depth d. Far away the half space moves as under a point force.
TEST(AxisymmetricContact, flatPunch) {
  constexpr Elasticity soft{100, 0.3};
  constexpr double depth = 1e-3;
  constexpr double size = 20;
  constexpr double force = 2 * depth * 100 / (1 - 0.09);
  const auto pointForce = [](int component) {
    return [component](double r, double y, double t) {
      const double nu = soft.poisson;
      const double z = -y;
      const double R = std::hypot(r, z);
      const double scale = t * force * (1 + nu) / (2 * pi * soft.young);
      return component == 0 ? scale * (r * z / (R * R * R) - (1 - 2 * nu) * r / (R * (R + z)))
                            : -scale * (z * z / (R * R * R) + 2 * (1 - nu) / R);
    };
  };
  for (const int nonmortar : {0, 1}) {
    Model model;
    model.bodies.emplace_back(
        "punch",
        rectangleMesh(
            {.upper = {1, 1}, .cellsX = 12, .cellsY = 12, .focus = Point(1, 0), .grading = {30, 30}},
            Cut::both),
        elasticMaterial({1e8, 0}, Plane::strain), Conditions{{{top, alongY, growing(-depth)}}, {}, {}}, 1,
        true);
    TriangleMesh block = rectangleMesh({.lower = {0, -size},
                                        .upper = {size, 0},
                                        .cellsX = 44,
                                        .cellsY = 36,
                                        .focus = Point(1, 0),
                                        .grading = {600, 600}},
                                       Cut::both);
    model.bodies.emplace_back("block", std::move(block), elasticMaterial(soft, Plane::strain),
                              Conditions{{{bottom, alongX, pointForce(0)},
                                          {bottom, alongY, pointForce(1)},
                                          {right, alongX, pointForce(0)},
                                          {right, alongY, pointForce(1)}},
                                         {},
                                         {}},
                              1, true);
    const ContactSide sides[] = {{0, bottom}, {1, top}};
    addAxisymmetric(model, sides[nonmortar], sides[1 - nonmortar], CouplingKind::weighted);
    const auto [state, report] = run(model, 1, 1);
    ASSERT_EQ(report.status, Status::converged) << report.reason;
    const ContactInterface& interface = model.interfaces[0];
    const Body& carrier = model.bodies[interface.pair().nonmortar.body];
    const Vector& p = state.contactForce[0];
    const Vector pressure = interface.contactPressure(p);
    const double found = p.sum();
    double worst = 0;
    for (Eigen::Index i = 0; i < p.size(); ++i) {
      const double r = carrier.elementNodes().places[interface.nonmortarNodes()[i]].x();
      if (r < 0.75)
        worst = std::max(worst, std::abs(pressure[i] * 2 * pi * std::sqrt(1 - r * r) / force - 1));
    }
    std::cout << "flat punch, nonmortar " << carrier.name() << ": force " << found / force
              << " of Boussinesq's, error of the pressure within 0.75 a at most " << worst << "\n";
    EXPECT_NEAR(found / force, 1, 0.01);
    EXPECT_LE(worst, 0.015);
  }
}

}  // namespace mortier::axisymmetric_contact_test
