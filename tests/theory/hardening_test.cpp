// Viscoplasticity by the overstress, hardening and plasticity in bodies, against exact and fine solutions.
#include <gtest/gtest.h>

#include <functional>
#include <iostream>

#include "material/overstress.h"
#include "theory/scenes.h"

namespace mortier::hardening_test {

using namespace scenes;

constexpr Scheme schemes[] = {Scheme::backwardEuler, Scheme::crankNicolson, Scheme::sdirk2};
constexpr Elasticity elasticity{100, 0.3};

/// A bar that is pulled (plane stress) or a square that is sheared (plane strain), by the equivalent
/// stress and strain, with a sign.
struct OnePath {
  Model model;
  double modulus = 0;  ///< of the equivalent stress over the equivalent strain [Pa]
  bool shear = false;
  [[nodiscard]] double mises(const State& state) const {
    return shear ? std::sqrt(1.5) * state.bodies[0].stress(2, 0)
                 : -std::sqrt(0.5) * (state.bodies[0].stress(1, 0) - state.bodies[0].stress(0, 0));
  }
};

/// The equivalent strain follows `course`, from a stress on.
OnePath path(const Overstress& law, Plane plane, const std::function<double(double)>& course,
             double first = 0) {
  OnePath path;
  path.shear = plane == Plane::strain;
  Conditions conditions;
  if (path.shear) {
    // s12 = mises/sqrt3, e12 = sqrt3/2 of the equivalent strain, u1 = 2 e12 y.
    path.modulus = 3 * elasticity.young / (2 * (1 + elasticity.poisson));
    for (const int label : {1, 2, 3, 4}) {
      conditions.displacements.push_back(
          {label, alongX, [=](double, double y, double t) { return std::sqrt(3.0) * course(t) * y; }});
      conditions.displacements.push_back({label, alongY, constant(0)});
    }
  } else {
    path.modulus = elasticity.young;
    conditions.displacements = {{left, alongX, constant(0)},
                                {bottom, alongY, constant(0)},
                                {top, alongY, [=](double, double, double t) { return course(t); }}};
  }
  if (first > 0)
    conditions.initialStresses = {
        {path.shear ? 2 : 1, {}, constant(path.shear ? first / std::sqrt(3) : first)}};
  path.model.bodies.emplace_back("bar", square(0, 1), overstressMaterial(elasticity, law, plane), conditions);
  return path;
}

/// The equivalent stress at the ends of `count` equal steps, by Runge-Kutta's method with steps of their own.
std::vector<double> fine(const Overstress& law, double modulus, const std::function<double(double)>& course,
                         double end, int count, double first = 0) {
  struct Y {
    double flow;
    double p;
  };
  const auto slope = [&](double t, const Y& y) {
    const double relative = first + modulus * (course(t) - y.flow) - law.kinematicHardening * y.flow;
    const double over = std::abs(relative) - law.yieldStress - law.isotropicHardening * y.p;
    const double rate = over > 0 ? law.referenceRate * std::pow(over / law.referenceStress, law.exponent) : 0;
    return Y{std::copysign(rate, relative), rate};
  };
  constexpr int each = 100;
  const double h = end / count / each;
  std::vector<double> stress;
  Y y{0, 0};
  for (int i = 0; i < count * each; ++i) {
    const double t = i * h;
    const auto after = [&](const Y& k, double part) { return Y{y.flow + part * k.flow, y.p + part * k.p}; };
    const Y a = slope(t, y);
    const Y b = slope(t + h / 2, after(a, h / 2));
    const Y c = slope(t + h / 2, after(b, h / 2));
    const Y d = slope(t + h, after(c, h));
    y = {y.flow + h / 6 * (a.flow + 2 * b.flow + 2 * c.flow + d.flow),
         y.p + h / 6 * (a.p + 2 * b.p + 2 * c.p + d.p)};
    if ((i + 1) % each == 0) stress.push_back(first + modulus * (course((i + 1) * h) - y.flow));
  }
  return stress;
}

/// Pulled, pushed back, pulled: 0 to 0.04 to -0.04 to ...
double cycles(double t) {
  const double x = std::fmod(t + 3, 4.0);
  return 0.04 * (x < 2 ? x - 1 : 3 - x);
}

// From a stress beyond yield on: where it yields between the ends of steps, orders are ragged.
TEST(Hardening, bodiesFollowTheLawWithTheOrderOfTheScheme) {
  const Overstress laws[] = {{1, 0.5, 0.05, 1},
                             {1, 0.5, 0.01, 3},
                             {1, 0.5, 0.05, 1, 15},
                             {1, 0.5, 0.05, 1, 0, 15},
                             {1, 0.5, 0.01, 3, 10, 20}};
  constexpr double end = 1;
  constexpr double first = 2;
  const auto course = [](double t) { return 0.01 * t * (1 + t); };
  for (const Plane plane : {Plane::stress, Plane::strain})
    for (const Overstress& law : laws) {
      const OnePath bar = path(law, plane, course, first);
      constexpr int most = 160;
      const std::vector<double> exact = fine(law, bar.modulus, course, end, most, first);
      for (const Scheme scheme : schemes) {
        std::vector<double> k;
        std::vector<double> errors;
        for (const int steps : {20, 40, 80, 160}) {
          State state = initialState(bar.model);
          double sum = 0;
          const RunReport run =
              march(bar.model, state, {.end = end, .steps = steps, .scheme = scheme}, {},
                    [&](const State& now, const StepReport& report) {
                      if (report.step > 0)
                        sum += std::abs(bar.mises(now) - exact[report.step * (most / steps) - 1]);
                    });
          ASSERT_EQ(run.status, Status::converged) << run.reason;
          k.push_back(end / steps);
          errors.push_back(sum / steps);
        }
        const double order = fittedOrder(k, errors);
        std::cout << (bar.shear ? "strain" : "stress") << ", law " << &law - laws << ", scheme "
                  << static_cast<int>(scheme) << ": order " << order << ", errors " << errors[0] << " ... "
                  << errors[3] << " of " << exact.back() << "\n";
        EXPECT_NEAR(order, scheme == Scheme::backwardEuler ? 1 : 2, 0.15);
        EXPECT_LE(errors.back(), scheme == Scheme::backwardEuler ? 1e-2 : 2e-4);
      }
    }
}

TEST(Hardening, stepsByTheirErrorKeepTheTolerance) {
  constexpr double tolerance = 1e-3;
  for (const Overstress& law : {Overstress{1, 0.5, 0.01, 3}, {1, 0.5, 0.05, 1, 15}, {1, 0.5, 0.05, 1, 5, 15}})
    for (const Scheme scheme : {Scheme::backwardEuler, Scheme::sdirk2}) {
      const OnePath bar = path(law, Plane::stress, cycles);
      State state = initialState(bar.model);
      double largest = 0;
      const RunReport run =
          march(bar.model, state, {.end = 2.5, .steps = 10, .scheme = scheme, .tolerance = tolerance}, {},
                [&](const State& now, const StepReport&) {
                  largest = std::max(largest, std::abs(bar.mises(now)));
                });
      ASSERT_EQ(run.status, Status::converged) << run.reason;
      const double error =
          std::abs(bar.mises(state) - fine(law, bar.modulus, cycles, 2.5, 400).back()) / largest;
      std::cout << "scheme " << static_cast<int>(scheme) << ": " << run.steps << " steps, error " << error
                << "\n";
      EXPECT_LE(error, tolerance);
    }
}

// Without viscosity: S = sigma_Y + (M T/(M + T)) (e - sigma_Y/M), T = H + K, and on the way back at 2 sigma_Y
// below (kinematic) or at - sigma_Y - K p (isotropic). Steps that end where the course turns are exact.
TEST(Hardening, plasticityIsExactOnStraightPaths) {
  for (const Plane plane : {Plane::stress, Plane::strain})
    for (const auto& [kinematic, isotropic] : {std::pair{0.0, 0.0}, {20.0, 0.0}, {0.0, 30.0}, {20.0, 30.0}})
      for (const Scheme scheme : {Scheme::backwardEuler, Scheme::sdirk2}) {
        const double H = kinematic;
        const double K = isotropic;
        const Overstress law{1, 0, 1, 1, H, K};
        const OnePath bar = path(law, plane, cycles);
        const double M = bar.modulus;
        State state = initialState(bar.model);
        double flow = 0;
        double p = 0;
        double worst = 0;
        const RunReport run = march(
            bar.model, state, {.end = 7, .steps = 28, .scheme = scheme}, {},
            [&](const State& now, const StepReport&) {
              const double relative = M * (cycles(now.time) - flow) - H * flow;
              const double dp = std::max(0.0, std::abs(relative) - law.yieldStress - K * p) / (M + H + K);
              flow += std::copysign(dp, relative);
              p += dp;
              worst = std::max(worst, std::abs(bar.mises(now) - M * (cycles(now.time) - flow)));
            });
        ASSERT_EQ(run.status, Status::converged) << run.reason;
        EXPECT_GT(p, 0.05);
        EXPECT_LE(worst, 1e-9) << H << ' ' << K;
        EXPECT_LE(run.iterations, 5 * 28 * (scheme == Scheme::sdirk2 ? 2 : 1));
      }
}

// A block on a wider one, pressed unevenly: what viscosity adds falls with it.
TEST(Hardening, plasticityIsTheLimitOfSmallViscosity) {
  for (const Plane plane : {Plane::stress, Plane::strain}) {
    const auto pressed = [&](double viscosity) {
      Overstress law{1, 0, 1, 1, 8, 5};
      law.setViscosity(viscosity);
      const auto material = overstressMaterial(elasticity, law, plane);
      const Function load = [](double x, double, double t) { return -2 * t * (1 + x); };
      Body upper("upper", square(0, 3), material, {{{left, alongX, constant(0)}}, {{top, alongY, load}}, {}});
      Body lower("lower", crissCrossMesh({.lower = {0, -1}, .upper = {2, 0}, .cellsX = 5, .cellsY = 3}),
                 material, {{{left, alongX, constant(0)}, {bottom, alongY, constant(0)}}, {}, {}});
      const auto [state, report] =
          run(contactModel(std::move(upper), std::move(lower), CouplingKind::mortar, upperBody), 1, 8);
      EXPECT_EQ(report.status, Status::converged) << report.reason;
      EXPECT_LE(report.iterations, 60);
      return state.bodies[0].displacement;
    };
    const Vector plastic = pressed(0);
    std::vector<double> viscosities;
    std::vector<double> errors;
    for (const double viscosity : {1e-2, 1e-3, 1e-4}) {
      viscosities.push_back(viscosity);
      errors.push_back((pressed(viscosity) - plastic).norm() / plastic.norm());
    }
    std::cout << "viscosity 1e-2, 1e-3, 1e-4: " << errors[0] << " " << errors[1] << " " << errors[2] << "\n";
    EXPECT_NEAR(fittedOrder(viscosities, errors), 1, 0.05);
    EXPECT_LE(errors.back(), 1e-4);
  }
}

/// Two bars side by side under a platen that presses them with the mean stress P (in yield stresses), the
/// foot of the first one raised by `lift` and lowered again, cycle by cycle. \returns how far the platen
/// sinks in each cycle.
std::vector<double> sinking(double P, double lift, double hardening, int cyclesOfLift) {
  constexpr double stiff = 1e9;
  Overstress law{1};
  law.kinematicHardening = hardening;
  const auto material = overstressMaterial({elasticity.young, 0}, law, Plane::stress);
  const auto bar = [&](double x, const Function& foot) {
    return Body(x > 0 ? "second" : "first",
                crissCrossMesh({.lower = {x, 0}, .upper = {x + 1, 1}, .cellsX = 1, .cellsY = 1}), material,
                {{{left, alongX, constant(0)}, {bottom, alongY, foot}}, {}, {}});
  };
  const auto raised = [=](double, double, double t) {
    const double x = t < 1 ? 0 : std::fmod(t - 1, 2.0);
    return lift * (x < 1 ? x : 2 - x);
  };
  const Function pressed = [=](double, double, double t) { return -P * std::min(1.0, t) * 2 / 3; };
  Model model;
  model.bodies.push_back(bar(0, raised));
  model.bodies.push_back(bar(2, constant(0)));
  model.bodies.emplace_back(
      "platen", crissCrossMesh({.lower = {0, 1}, .upper = {3, 2}, .cellsX = 3, .cellsY = 1}),
      elasticMaterial({stiff, 0}),
      Conditions{{{left, alongX, constant(0)}, {right, alongX, constant(0)}}, {{top, alongY, pressed}}, {}});
  for (const int b : {0, 1}) addInterface(model, {{b, top}, {2, bottom}, CouplingKind::mortar});
  State state = initialState(model);
  std::vector<double> depth;
  const RunReport run =
      march(model, state, {.end = 1.0 + 2 * cyclesOfLift, .steps = 4 * (1 + 2 * cyclesOfLift)}, {},
            [&](const State& now, const StepReport& report) {
              if (report.step > 0 && report.step % 8 == 4) {
                double sum = 0;
                for (int v = 0; v < model.bodies[2].nodes(); ++v)
                  sum += now.bodies[2].displacement[2 * v + 1];
                depth.push_back(-sum / model.bodies[2].nodes());
              }
            });
  EXPECT_EQ(run.status, Status::converged) << run.reason;
  std::vector<double> each;
  for (size_t i = 1; i < depth.size(); ++i) each.push_back(depth[i] - depth[i - 1]);
  return each;
}

// Bree's problem with two bars (Parkes): stresses P -+ E lift/2. They stay elastic up to E lift/2 = 1 - P,
// shake down up to 2 (1 - P), and beyond that sink in each cycle by lift - 4 (sigma_Y - P)/E.
TEST(Hardening, barsShakeDownOrRatchetAtBreesLimits) {
  const double E = elasticity.young;
  for (const double P : {0.7, 0.85}) {
    const double limit = 4 * (1 - P) / E;  // of the lift
    for (const double part : {0.4, 0.9, 0.99, 1.01, 1.3}) {
      const std::vector<double> each = sinking(P, part * limit, 0, 4);
      const double exact = std::max(0.0, part - 1) * limit;
      std::cout << "P " << P << ", lift over its limit " << part << ": sinks by " << each[1] << " " << each[3]
                << ", exact " << exact << "\n";
      for (size_t i = 1; i < each.size(); ++i) EXPECT_NEAR(each[i], exact, 1e-6 * limit);
    }
    // Prager's bars shake down at last.
    const std::vector<double> each = sinking(P, 1.3 * limit, 0.3 * E, 12);
    std::cout << "with hardening " << each[0] << " ... " << each.back() << "\n";
    EXPECT_GT(each[0], 1e-2 * limit);
    EXPECT_LE(std::abs(each.back()), 1e-3 * each[0]);
  }
}

}  // namespace mortier::hardening_test
