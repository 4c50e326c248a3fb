// A rigid cylinder pressed at once onto the standard linear solid, in plane strain (E. H. Lee, J. R. M.
// Radok, The contact problem for viscoelastic bodies, J. Appl. Mech. 27, 1960). While the contact grows,
//   a(t)^2 = (4 P R/pi) phi(t),   p(x, t) = 1/(2 R) integral of psi(t - s) d (a(s)^2 - x^2)^(1/2),
// phi the creep of the half plane's compliance (1/G + 3/(3 K + G))/4 = (1 - nu^2)/E, psi the relaxation of
// its inverse G + 9 K/4 - (27 K^2/4)/(3 K + 4 G), where G relaxes and K does not.
#include <gtest/gtest.h>

#include <iostream>
#include <numbers>

#include "material/viscoelastic.h"
#include "theory/scenes.h"

namespace mortier::viscoelastic_contact_test {

using namespace scenes;

constexpr Elasticity elasticity{100, 0.3};
constexpr double tau = 0.5;
constexpr double g = 0.4;
constexpr double radius = 4;
constexpr double load = 3;  ///< of the half that is modelled [N/m]
constexpr double atOnce = 1e-9;
constexpr double size = 12;

const double G = elasticity.young / (2 * (1 + elasticity.poisson));
const double K = elasticity.young / (3 * (1 - 2 * elasticity.poisson));

/// What 1/(3 K + c G) is in time.
double softening(double c, double t) {
  const double rest = 1 / (3 * K + c * g * G);
  const double rate = (3 * K + c * g * G) / ((3 * K + c * G) * tau);
  return rest + (1 / (3 * K + c * G) - rest) * std::exp(-rate * t);
}
double phi(double t) {
  return ((1 + (1 - g) / g * (1 - std::exp(-g * t / tau))) / G + 3 * softening(1, t)) / 4;
}
double psi(double t) {
  return G * (g + (1 - g) * std::exp(-t / tau)) + 9 * K / 4 - 27 * K * K / 4 * softening(4, t);
}
double halfWidth(double t) {
  return std::sqrt(8 * load * radius / std::numbers::pi * phi(t));
}

/// 1/(2 R) integral of psi(t - s) d f(a(s)), the contact being there from 0 on.
template <class Of>
double memory(double t, Of of) {
  constexpr int parts = 4000;
  double sum = psi(t) * of(halfWidth(0));
  for (int i = 0; i < parts; ++i) {
    const double s0 = t * i / parts;
    const double s1 = t * (i + 1) / parts;
    sum += psi(t - (s0 + s1) / 2) * (of(halfWidth(s1)) - of(halfWidth(s0)));
  }
  return sum / (2 * radius);
}

double pressureAt(double x, double t) {
  return memory(t, [=](double a) { return std::sqrt(std::max(0.0, a * a - x * x)); });
}

/// Half of it: a stiff block with a parabola for its distance, on a block far larger than the contact.
Model pressedHalf() {
  constexpr double stiff = 1e8;
  Model model;
  model.bodies.emplace_back(
      "cylinder", rectangleMesh({.lower = {0, 0}, .upper = {size, 1}, .cellsX = 3, .cellsY = 1}),
      elasticMaterial({stiff, 0.3}),
      Conditions{
          {{left, alongX, constant(0)}},
          {{top, alongY, [](double, double, double t) { return -load / size * std::min(1.0, t / atOnce); }}},
          {}});
  model.bodies.emplace_back("block",
                            crissCrossMesh({.lower = {0, -size},
                                            .upper = {size, 0},
                                            .cellsX = 60,
                                            .cellsY = 36,
                                            .focus = Point(0, 0),
                                            .grading = {40, 60}}),
                            viscoelasticMaterial(elasticity, {tau, g}, Plane::strain),
                            Conditions{{{left, alongX, constant(0)}, {bottom, alongY, constant(0)}}, {}, {}});
  InterfaceOptions options;
  options.gap = still([](const Point& x) { return x.x() * x.x() / (2 * radius); });
  addInterface(model, {{1, top}, {0, bottom}, CouplingKind::mortar}, options);
  return model;
}

TEST(ViscoelasticContact, growsAsLeeAndRadokSay) {
  const Model model = pressedHalf();
  const ContactInterface& interface = model.interfaces[0];
  State state = initialState(model);
  double worst = 0;
  double first = 0;
  double last = 0;
  const auto look = [&](const State& now, const StepReport&) {
    if (now.time == 0) return;
    const double a = halfWidth(now.time);
    const double peak = pressureAt(0, now.time);
    // Of the pressure: integral of x^2 (a^2 - x^2)^(1/2) = pi a^4/16.
    const double moment = memory(now.time, [](double w) { return std::numbers::pi * std::pow(w, 4) / 16; });
    const Vector pressure = interface.contactPressure(now.contactForce[0]);
    double sum = 0;
    double apart = 0;
    for (Eigen::Index i = 0; i < pressure.size(); ++i) {
      const double x = model.bodies[1].mesh().vertices[interface.nonmortarNodes()[i]].x();
      sum += now.contactForce[0][i] * x * x;
      if (x < 0.8 * a) apart = std::max(apart, std::abs(pressure[i] - pressureAt(x, now.time)) / peak);
    }
    const double width = std::sqrt(sum / moment);
    if (first == 0) first = a;
    last = a;
    std::cout << "t " << now.time << ": half width " << a << ", its measure off by " << width - 1
              << ", pressure by " << apart << ", largest " << pressure.maxCoeff() << ", exact " << peak
              << "\n";
    worst = std::max({worst, std::abs(width - 1), std::abs(pressure.maxCoeff() / peak - 1), apart});
  };
  ASSERT_EQ(march(model, state, {.end = atOnce, .steps = 1}, {}, look).status, Status::converged);
  MarchMemory start;
  start.begin = state.time;
  const RunReport run =
      march(model, state, start, {.end = 2, .steps = 10, .scheme = Scheme::sdirk2}, {}, look);
  ASSERT_EQ(run.status, Status::converged) << run.reason;
  EXPECT_LE(worst, 0.02);
  EXPECT_GT(last, 1.3 * first);
}

}  // namespace mortier::viscoelastic_contact_test
