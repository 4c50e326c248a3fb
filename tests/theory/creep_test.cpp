// Norton creep in bodies against closed forms: relaxation of a bar, steady creep of a thick cylinder, the
// same blocks in other units.
#include <gtest/gtest.h>

#include <iostream>

#include "material/norton.h"
#include "theory/scenes.h"

namespace mortier::creep_test {

using namespace scenes;

constexpr Scheme schemes[] = {Scheme::backwardEuler, Scheme::crankNicolson, Scheme::sdirk2};

// A bar stretched once and then held: s' = -E rate0 (s/s0)^n,
//   s^(1-n) = s_1^(1-n) + (n-1) E rate0 s0^-n t.
TEST(Norton, heldBarsRelaxWithTheOrderOfTheScheme) {
  constexpr double young = 150;
  constexpr double first = 2;
  const NortonCreep creep{1.5, 4e-3, 5};
  const auto exact = [&](double t) {
    const double n = creep.exponent;
    return std::pow(std::pow(first, 1 - n) +
                        (n - 1) * young * creep.referenceRate * std::pow(creep.referenceStress, -n) * t,
                    1 / (1 - n));
  };
  Conditions conditions{
      {{left, alongX, constant(0)}, {bottom, alongY, constant(0)}, {top, alongY, constant(0)}}, {}, {}};
  conditions.initialStresses = {{1, {}, constant(first)}};
  Model model;
  model.bodies.emplace_back("bar", square(0, 1), nortonMaterial({young, 0.3}, creep, Plane::stress),
                            conditions);
  for (const Scheme scheme : schemes) {
    std::vector<double> k;
    std::vector<double> errors;
    for (const int steps : {20, 40, 80}) {
      State state = initialState(model);
      double worst = 0;
      const RunReport run = march(
          model, state, {.end = 2, .steps = steps, .scheme = scheme}, {},
          [&](const State& now, const StepReport&) {
            worst = std::max(worst, std::abs(vonMises(now.bodies[0].stress.col(0)) / exact(now.time) - 1));
          });
      ASSERT_EQ(run.status, Status::converged) << run.reason;
      EXPECT_NEAR(state.bodies[0].stress(0, 0), -state.bodies[0].stress(1, 0), 1e-12);  // uniaxial
      k.push_back(2.0 / steps);
      errors.push_back(worst);
    }
    const double order = fittedOrder(k, errors);
    std::cout << "scheme " << static_cast<int>(scheme) << ": order " << order << ", errors " << errors[0]
              << " " << errors[1] << " " << errors[2] << "\n";
    EXPECT_NEAR(order, scheme == Scheme::backwardEuler ? 1 : 2, 0.15);
    EXPECT_LE(errors.back(), scheme == Scheme::backwardEuler ? 0.02 : 1e-3);
  }
  EXPECT_LT(exact(2), 0.7 * first);
}

// Steps chosen by their error, to the same end.
TEST(Norton, stepsByTheirErrorKeepTheTolerance) {
  constexpr double young = 150;
  constexpr double tolerance = 1e-3;
  const NortonCreep creep{1.5, 4e-2, 5};
  Conditions conditions{
      {{left, alongX, constant(0)}, {bottom, alongY, constant(0)}, {top, alongY, constant(0)}}, {}, {}};
  conditions.initialStresses = {{1, {}, constant(2)}};
  Model model;
  model.bodies.emplace_back("bar", square(0, 1), nortonMaterial({young, 0.3}, creep, Plane::stress),
                            conditions);
  for (const Scheme scheme : {Scheme::backwardEuler, Scheme::sdirk2}) {
    State state = initialState(model);
    double worst = 0;
    const RunReport run =
        march(model, state, {.end = 2, .steps = 10, .scheme = scheme, .tolerance = tolerance}, {},
              [&](const State& now, const StepReport& report) {
                if (report.step == 0) worst = 0;  // another trial

                const double exact =
                    std::pow(std::pow(2, -4.0) + 4 * young * 4e-2 * std::pow(1.5, -5) * now.time, -0.25);
                worst = std::max(worst, std::abs(vonMises(now.bodies[0].stress.col(0)) - exact) / 2);
              });
    ASSERT_EQ(run.status, Status::converged) << run.reason;
    std::cout << "scheme " << static_cast<int>(scheme) << ": " << run.steps << " steps, error " << worst
              << "\n";
    EXPECT_LE(worst, tolerance);
    EXPECT_GE(worst, 0.02 * tolerance);
  }
}

// Steady creep under inner pressure p in plane strain, a = 1, b = 2 (Odqvist; Bailey):
//   s_rr = -p ((b/r)^(2/n) - 1)/q,   s_tt = -p ((1 - 2/n) (b/r)^(2/n) - 1)/q,   s33 = (s_rr + s_tt)/2,
//   q = (b/a)^(2/n) - 1.
TEST(Norton, thickCylinderTendsToTheSteadyStresses) {
  constexpr double pressure = 80e6;
  for (const double n : {1.0, 3.0, 5.0, 10.0}) {
    const NortonCreep creep{1e8, 1e-8, n};
    Model model;
    model.bodies.emplace_back("ring",
                              annulusMesh({.quarters = 1, .cellsAround = 24, .cellsAcross = 8}, Cut::both),
                              nortonMaterial({2e11, 0.3}, creep, Plane::strain),
                              Conditions{{{3, alongNormal, constant(0)}, {4, alongNormal, constant(0)}},
                                         {{1, alongNormal, constant(-pressure)}},
                                         {}},
                              2);
    const auto [state, report] = run(model, 1e12, 2);
    ASSERT_EQ(report.status, Status::converged) << "n " << n << ": " << report.reason;
    const Body& body = model.bodies[0];
    const double q = std::pow(2, 2 / n) - 1;
    double worst = 0;
    for (int i = 0; i < body.points(); ++i) {
      const auto& triangle = body.mesh().triangles[i / 3];
      Point x = Point::Zero();
      for (int v = 0; v < 3; ++v) x += (v == i % 3 ? 2.0 / 3 : 1.0 / 6) * body.mesh().vertices[triangle[v]];
      const double r = x.norm();
      const double power = std::pow(2 / r, 2 / n);
      const double radial = -pressure * (power - 1) / q;
      const double hoop = -pressure * ((1 - 2 / n) * power - 1) / q;
      const Eigen::Vector3d s = toCartesian(state.bodies[0].stress.col(i).head<3>());
      const Point e = x / r;
      const double rr = s[0] * e[0] * e[0] + s[1] * e[1] * e[1] + 2 * s[2] * e[0] * e[1];
      const double tt = s[0] * e[1] * e[1] + s[1] * e[0] * e[0] - 2 * s[2] * e[0] * e[1];
      worst = std::max({worst, std::abs(rr - radial), std::abs(tt - hoop),
                        std::abs(state.bodies[0].stress(3, i) - (radial + hoop) / 2)});
    }
    const double largest = std::max(pressure, pressure / q * std::abs((1 - 2 / n) - 1));
    std::cout << "n = " << n << ": largest error " << worst / largest << " of the largest stress, "
              << report.iterations << " linear solves\n";
    EXPECT_LE(worst, 5e-3 * largest);
    EXPECT_LE(report.iterations, 30);
  }
}

// Units of length, stress and time change no iteration count, nor does the pair by which creep is given.
TEST(Norton, unitsChangeNoIterationCount) {
  const auto iterations = [](double stress, double time, double reference) {
    const double n = 7;
    const NortonCreep creep{stress * reference, 1e-3 / time * std::pow(reference, n), n};
    const auto material = nortonMaterial({1e3 * stress, 0.3}, creep, Plane::stress);
    const Function load = [=](double x, double, double) { return -stress * (1 + x); };
    Body upper("upper", square(0, 2), material, {{{left, 0, constant(0)}}, {{top, 1, load}}, {}});
    Body lower("lower", square(-1, 3), material,
               {{{left, 0, constant(0)}, {bottom, 1, constant(0)}}, {}, {}});
    const auto [state, report] =
        run(contactModel(std::move(upper), std::move(lower), CouplingKind::mortar, upperBody), 50 * time, 3);
    EXPECT_EQ(report.status, Status::converged) << report.reason;
    return report.iterations;
  };
  const int once = iterations(1, 1, 1);
  EXPECT_LE(once, 45);
  for (const double stress : {1e-9, 1e9})
    for (const double time : {1e-9, 1e9}) EXPECT_EQ(iterations(stress, time, 1), once);
  EXPECT_EQ(iterations(1, 1, 1e4), once);
  EXPECT_EQ(iterations(1, 1, 1e-4), once);
}

// A block on a wider one, loaded on half of its top or moved, from no stress on: steps of a millionth to 1e11
// times the time in which the stress of the load creeps by the elastic strain.
TEST(Norton, hardStepsAreSolved) {
  constexpr double easy = 15;
  for (const Plane plane : {Plane::stress, Plane::strain})
    for (const bool moved : {false, true})
      for (const double n : {3.0, 10.0, 50.0})
        for (const double time : {1e-3, 1e3, 1e14}) {
          const auto material = nortonMaterial({1e3, 0.3}, {1, 1e-3, n}, plane);
          const Function load = [](double x, double, double) { return x < 0.5 ? -1 : 0; };
          const Function push = [=](double x, double, double t) { return -0.02 * (1 + x) * t / time; };
          Conditions conditions{{{left, alongX, constant(0)}}, {}, {}};
          if (moved)
            conditions.displacements.push_back({top, alongY, push});
          else
            conditions.tractions.push_back({top, alongY, load});
          Body upper("upper", square(0, 4), material, conditions);
          Body lower(
              "lower", crissCrossMesh({.lower = {-1, -2}, .upper = {2, 0}, .cellsX = 9, .cellsY = 6}),
              material,
              {{{left, alongX, constant(0)}, {bottom, alongX, constant(0)}, {bottom, alongY, constant(0)}},
               {},
               {}});
          const auto [state, report] =
              run(contactModel(std::move(upper), std::move(lower), CouplingKind::mortar, upperBody), time, 1);
          EXPECT_EQ(report.status, Status::converged)
              << "n " << n << ", time " << time << (moved ? ", moved: " : ", loaded: ") << report.reason;
          if (n == 3 && time < 1e4) {
            EXPECT_LE(report.iterations, easy);
          }
        }
}

}  // namespace mortier::creep_test
