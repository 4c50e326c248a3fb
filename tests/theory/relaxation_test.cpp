// Maxwell's body and the standard linear solid against closed forms.
#include "material/viscoelastic.h"

#include <gtest/gtest.h>

#include <iostream>

#include "theory/scenes.h"

namespace mortier::relaxation_test {

using namespace scenes;

constexpr Scheme schemes[] = {Scheme::backwardEuler, Scheme::crankNicolson, Scheme::sdirk2};
constexpr Elasticity elasticity{100, 0.3};
constexpr double G0 = 100 / 2.6;
constexpr double tau = 0.5;
constexpr double atOnce = 1e-9;  // of the run: loads are there

double relaxation(double g, double t) {
  return G0 * (g + (1 - g) * std::exp(-t / tau));
}
double compliance(double g, double t) {
  return g > 0 ? (1 + (1 - g) / g * (1 - std::exp(-g * t / tau))) / G0 : (1 + t / tau) / G0;
}

/// Largest error over a run of what `valueOf` says of the state, relative; loads act in a first, tiny step.
template <class Value, class Exact>
double errorOf(const Model& model, TimePlan plan, Value valueOf, Exact exact) {
  State state = initialState(model);
  const RunReport first =
      march(model, state, {.end = atOnce, .steps = 1}, {}, [](const State&, const StepReport&) {});
  EXPECT_EQ(first.status, Status::converged) << first.reason;
  MarchMemory memory;
  memory.begin = state.time;
  double worst = 0;
  const RunReport run =
      march(model, state, memory, plan, {}, [&](const State& now, const StepReport& report) {
        if (report.step == 0) worst = 0;  // another trial
        worst = std::max(worst, std::abs(valueOf(now) / exact(now.time) - 1));
      });
  EXPECT_EQ(run.status, Status::converged) << run.reason;
  EXPECT_LE(run.iterations, 3 * run.steps * 2);
  return worst;
}

/// A bar under a constant stress, in plane stress: eps = s/(9 K) + s/3 J(t).
Model pulledBar(double g) {
  Model model;
  model.bodies.emplace_back(
      "bar", square(0, 1), viscoelasticMaterial(elasticity, {tau, g}, Plane::stress),
      Conditions{
          {{left, alongX, constant(0)}, {bottom, alongY, constant(0)}}, {{top, alongY, constant(1)}}, {}});
  return model;
}

/// A square sheared at once and held, in plane strain: s12 = G(t).
Model shearedSquare(double g) {
  Conditions conditions;
  for (const int label : {1, 2, 3, 4}) {
    conditions.displacements.push_back(
        {label, alongX, [](double, double y, double t) { return y * std::min(1.0, t / atOnce); }});
    conditions.displacements.push_back({label, alongY, constant(0)});
  }
  Model model;
  model.bodies.emplace_back("square", square(0, 2), viscoelasticMaterial(elasticity, {tau, g}, Plane::strain),
                            conditions);
  return model;
}

TEST(Viscoelastic, barsCreepAndSquaresRelaxWithTheOrderOfTheScheme) {
  const double bulk = 100 / (3 * (1 - 2 * 0.3));
  const auto shear = [](const State& state) { return state.bodies[0].stress(2, 0) / std::sqrt(2); };
  for (const double g : {0.0, 0.3}) {
    const Model bar = pulledBar(g);
    const Model sheared = shearedSquare(g);
    int corner = -1;
    for (int v = 0; v < bar.bodies[0].nodes(); ++v)
      if (bar.bodies[0].mesh().vertices[v] == Point(1, 1)) corner = v;
    ASSERT_GE(corner, 0);
    const auto top = [=](const State& state) { return state.bodies[0].displacement[2 * corner + 1]; };
    const auto creep = [=](double t) { return 1 / (9 * bulk) + compliance(g, t) / 3; };
    const auto relax = [=](double t) { return relaxation(g, t); };
    for (const Scheme scheme : schemes)
      for (const bool creeps : {true, false}) {
        std::vector<double> k;
        std::vector<double> errors;
        for (const int steps : {10, 20, 40}) {
          const TimePlan plan{.end = 1, .steps = steps, .scheme = scheme};
          k.push_back(1.0 / steps);
          errors.push_back(creeps ? errorOf(bar, plan, top, creep) : errorOf(sheared, plan, shear, relax));
        }
        std::cout << "scheme " << static_cast<int>(scheme) << ", g = " << g
                  << (creeps ? ", creep" : ", relaxation") << ": errors " << errors[0] << " " << errors[1]
                  << " " << errors[2] << "\n";
        if (g == 0 && creeps) {
          EXPECT_LE(errors[0], 1e-9);  // the strain grows linearly
          continue;
        }
        const double order = scheme == Scheme::backwardEuler ? 1 : 2;
        EXPECT_NEAR(fittedOrder(k, errors), order, 0.15);
        EXPECT_LE(errors[0], order == 1 ? 0.2 : 0.02);
      }
  }
}

TEST(Viscoelastic, stepsByTheirErrorKeepTheTolerance) {
  constexpr double tolerance = 1e-4;
  const auto shear = [](const State& state) { return state.bodies[0].stress(2, 0) / std::sqrt(2); };
  for (const double g : {0.0, 0.3}) {
    const double error = errorOf(
        shearedSquare(g), {.end = 1, .steps = 10, .scheme = Scheme::sdirk2, .tolerance = tolerance},
        [&](const State& state) { return shear(state) / G0 + 1; },
        [&](double t) { return relaxation(g, t) / G0 + 1; });
    std::cout << "g = " << g << ": error " << error << " of " << tolerance << "\n";
    EXPECT_LE(error, tolerance);
    EXPECT_GE(error, 0.01 * tolerance);
  }
}

// The spring knows the strain since t = 0: a stress that was there does not relax to nothing.
TEST(Viscoelastic, initialStressIsElastic) {
  Conditions conditions;
  for (const int label : {1, 2, 3, 4})
    for (const int c : {alongX, alongY}) conditions.displacements.push_back({label, c, constant(0)});
  conditions.initialStresses = {{2, {}, constant(3)}};
  Model model;
  model.bodies.emplace_back("square", square(0, 1),
                            viscoelasticMaterial(elasticity, {tau, 0.25}, Plane::stress), conditions);
  const auto [state, report] = run(model, 100 * tau, 20);
  ASSERT_EQ(report.status, Status::converged) << report.reason;
  EXPECT_NEAR(state.bodies[0].stress(2, 0) / std::sqrt(2), 3 * 0.25, 1e-3);
}

}  // namespace mortier::relaxation_test
