// A thick cylinder under inner pressure in plane strain, a = 1, b = 2, as a quarter ring between rollers:
// Lame's elastic one, and steady creep of the viscoplastic one.
#include <gtest/gtest.h>

#include <iostream>
#include <numbers>

#include "material/deviatoric.h"
#include "theory/scenes.h"

namespace mortier::thick_cylinder_test {

using namespace scenes;

constexpr double inner = 1;
constexpr double outer = 2;

Model quarterRing(int cells, double pressure, const std::shared_ptr<const Material>& material) {
  Model model;
  model.bodies.emplace_back(
      "ring", annulusMesh({.quarters = 1, .cellsAround = 2 * cells, .cellsAcross = cells}, Cut::both),
      material,
      Conditions{{{3, alongNormal, constant(0)}, {4, alongNormal, constant(0)}},
                 {{1, alongNormal, constant(-pressure)}},
                 {}});
  return model;
}

/// Mean and spread of the radial displacement on the inner circle.
Range radialAtInner(const Body& body, const Vector& u) {
  Range range;
  for (int v = 0; v < body.nodes(); ++v) {
    const Point& x = body.mesh().vertices[v];
    if (std::abs(x.norm() - inner) < 1e-9) range.add(x.normalized().dot(u.segment<2>(2 * v)));
  }
  return range;
}

/// Area, and the integral of a function of the stress at the centre of each triangle.
template <class F>
double mean(const Body& body, const Matrix& stress, F f) {
  double area = 0;
  double sum = 0;
  for (int i = 0; i < body.points(); ++i) {
    area += body.weights()[i];
    sum += body.weights()[i] * f(stress.col(i));
  }
  return sum / area;
}

// u_r = (1 + nu)/E p a^2/(b^2 - a^2) ((1 - 2 nu) r + b^2/r), s33 = 2 nu p a^2/(b^2 - a^2) everywhere.
TEST(ThickCylinder, tendsToLame) {
  constexpr double E = 100;
  constexpr double pressure = 10;
  for (const double nu : {0.3, 0.49}) {
    const double c = pressure * inner * inner / (outer * outer - inner * inner);
    const auto radial = [&](double r) { return (1 + nu) / E * c * ((1 - 2 * nu) * r + outer * outer / r); };
    std::vector<double> h;
    std::vector<double> errors;
    double s33 = 0;
    for (const int cells : {4, 8, 16}) {
      const Model model = quarterRing(cells, pressure, elasticMaterial({E, nu}, Plane::strain));
      const auto [state, report] = run(model, 1, 1);
      ASSERT_EQ(report.status, Status::converged) << report.reason;
      EXPECT_EQ(report.iterations, 1);
      const Body& body = model.bodies[0];
      double worst = 0;
      for (int v = 0; v < body.nodes(); ++v) {
        const Point& x = body.mesh().vertices[v];
        const Point u = state.bodies[0].displacement.segment<2>(2 * v);
        worst = std::max(worst, (u - radial(x.norm()) * x.normalized()).norm());
      }
      h.push_back(1.0 / cells);
      errors.push_back(worst / radial(inner));
      s33 = mean(body, state.bodies[0].stress, [](const auto& s) { return s[3]; });
      // eps33 = 0: s33 = nu (s11 + s22) in every triangle.
      for (int i = 0; i < body.points(); ++i)
        EXPECT_NEAR(state.bodies[0].stress(3, i), nu * std::numbers::sqrt2 * state.bodies[0].stress(0, i),
                    1e-12 * pressure);
    }
    std::cout << "Lame's cylinder, nu = " << nu << ": errors " << errors[0] << " " << errors[1] << " "
              << errors[2] << ", order " << fittedOrder(h, errors) << ", mean s33 " << s33 << " (exact "
              << 2 * nu * c << ")\n";
    EXPECT_GE(fittedOrder(h, errors), 1.8);
    EXPECT_LE(errors.back(), 3e-3);
    EXPECT_NEAR(s33, 2 * nu * c, 0.02 * c);
  }
}

// In steady creep the stress stands still and u_r' = C/r: with tau = s_tt - s_rr = 2 (s_Y/sqrt3 + lambda'
// C/r^2), and 2 lambda dev eps' = (1 - s_Y/vM) dev s, equilibrium r s_rr' = tau integrates to
//   p = (2/sqrt3) s_Y ln(b/a) + 2 lambda C (1/a^2 - 1/b^2).
constexpr double viscosity = 10;
constexpr double yieldStress = 1;
constexpr double creepPressure = 1.2;

double limitPressure() {
  return 2 / std::numbers::sqrt3 * yieldStress * std::log(outer / inner);
}
double creepConstant() {
  return (creepPressure - limitPressure()) / (2 * viscosity * (1 / (inner * inner) - 1 / (outer * outer)));
}

TEST(ThickCylinder, steadyCreepGoesAtTheKnownRate) {
  EXPECT_NEAR(creepConstant(), 0.02664150516, 1e-11);
  constexpr double steady = 1e5;  // relaxation times
  constexpr double young = 100;
  constexpr double nu = 0.3;
  const double time = steady * 2 * viscosity / young;
  std::vector<double> h;
  std::vector<double> errors;
  for (const int cells : {4, 8, 16}) {
    const Model model = quarterRing(cells, creepPressure,
                                    perzynaMaterial({young, nu}, {viscosity, yieldStress}, Plane::strain));
    const Result half = run(model, time / 2, 2);
    const Result whole = run(model, time, 4);
    ASSERT_EQ(whole.report.status, Status::converged) << whole.report.reason;
    const Vector rate = (whole.state.bodies[0].displacement - half.state.bodies[0].displacement) / (time / 2);
    const Range radial = radialAtInner(model.bodies[0], rate);
    h.push_back(1.0 / cells);
    errors.push_back(radial.distance(creepConstant() / inner) / creepConstant());
    std::cout << "steady creep, " << cells << " cells across: u'(a) " << radial.min << " to " << radial.max
              << " (exact " << creepConstant() << "), " << whole.report.iterations << " linear solves\n";
    // Plane strain to the end: eps33 = 0, and what flows keeps its volume.
    const BodyState& body = whole.state.bodies[0];
    Matrix elastic;
    model.bodies[0].material().elasticStrain(body.stress, elastic);
    const double largest = body.viscoplasticStrain.cwiseAbs().maxCoeff();
    EXPECT_LE((elastic.row(3) + body.viscoplasticStrain.row(3)).cwiseAbs().maxCoeff(), 1e-12 * largest);
    EXPECT_LE((std::numbers::sqrt2 * body.viscoplasticStrain.row(0) + body.viscoplasticStrain.row(3))
                  .cwiseAbs()
                  .maxCoeff(),
              1e-12 * largest);
    // s33 is half of s_rr + s_tt where the cylinder flows: its deviator does not flow along the axis.
    for (int i = 0; i < model.bodies[0].points(); ++i)
      EXPECT_NEAR(body.stress(3, i), std::numbers::sqrt2 / 2 * body.stress(0, i), 1e-3);
  }
  std::cout << "  order " << fittedOrder(h, errors) << "\n";
  EXPECT_GE(fittedOrder(h, errors), 1.8);
  EXPECT_LE(errors.back(), 1e-2);
}

// Below the limit pressure the cylinder comes to rest, above it it never does.
TEST(ThickCylinder, limitPressureDividesRestFromFlow) {
  for (const double excess : {-0.05, 0.05}) {
    const Model model = quarterRing(8, limitPressure() * (1 + excess),
                                    perzynaMaterial({100, 0.3}, {viscosity, yieldStress}, Plane::strain));
    const Result before = run(model, 1e6, 2);
    const Result after = run(model, 2e6, 4);
    ASSERT_EQ(after.report.status, Status::converged) << after.report.reason;
    const double rate = radialAtInner(model.bodies[0], after.state.bodies[0].displacement -
                                                           before.state.bodies[0].displacement)
                            .mean() /
                        1e6;
    const double expected = std::max(0.0, excess) * limitPressure() /
                            (2 * viscosity * (1 / (inner * inner) - 1 / (outer * outer)));
    std::cout << "pressure " << 1 + excess << " of the limit: rate " << rate << ", expected " << expected
              << "\n";
    EXPECT_NEAR(rate, expected, 0.25 * std::abs(excess) * limitPressure() / (2 * viscosity * 0.75));
  }
}

}  // namespace mortier::thick_cylinder_test
