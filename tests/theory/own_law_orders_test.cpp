// Orders in time of a law that the program does not have, at a point and in bodies in contact, and of flow in
// a body that is heated: against solutions in closed form, all schemes.
#include <gtest/gtest.h>

#include <iostream>

#include "material/overstress.h"
#include "material/own_material.h"
#include "material/rate_law.h"
#include "theory/controlled_runs.h"
#include "theory/scenes.h"

namespace mortier::own_law_orders_test {

using namespace scenes;

constexpr Scheme schemes[] = {Scheme::backwardEuler, Scheme::crankNicolson, Scheme::sdirk2};
constexpr Elasticity elasticity{100, 0.3};
constexpr double orderTolerance = 0.15;

int orderOf(Scheme scheme) {
  return scheme == Scheme::backwardEuler ? 1 : 2;
}

/// A dashpot of the rate A sinh(x/S) beside a spring K, along y and in shear: x = s - K eps_v. It depends on
/// the strain, as eps_v = eps - E^-1 s.
struct SinhDashpot {
  static constexpr bool needsTotalStrain = true;
  static constexpr double A = 0.01;  // [1/s]
  static constexpr double S = 0.5;   // [Pa]
  static constexpr double K = 15;    // [Pa]
  template <class Number>
  Components<Number> rateOf(const Components<Number>& s, const Components<Number>& e) const {
    using std::sinh;
    const auto& [young, poisson] = elasticity;
    const Number along = s.c22 - K * (e.c22 - (s.c22 - poisson * s.c11) / young);
    const Number shear = s.c12 - K * (e.c12 - (1 + poisson) / young * s.c12);
    const Number none(0.0);
    return {none, Number(A * sinh(along / S)), Number(A * sinh(shear / S)), none};
  }
  /// x' = -stiffness A sinh(x/S) from x0.
  static double decayed(double x0, double stiffness, double t) {
    return 2 * S * std::atanh(std::tanh(x0 / (2 * S)) * std::exp(-stiffness * A * t / S));
  }
};

std::shared_ptr<const Material> material() {
  OwnLaw own;
  own.name = "own";
  own.law = rateLaw(SinhDashpot());
  own.where = "here";
  return ownMaterial(elasticity, own, Plane::stress);
}

// A square held on all sides relaxes from a shear stress s0: with E/(1 + nu) = M,
//   x' = -(M + K) A sinh(x/S),   s = (x + K e)/(1 + K/M),   e = s0/M.
constexpr double s0 = 1.2;
constexpr double M = 100 / 1.3;

Model heldSquare() {
  Conditions held;
  for (const int side : {bottom, right, top, left})
    for (const int component : {0, 1}) held.displacements.push_back({side, component, constant(0)});
  held.initialStresses = {{2, std::nullopt, constant(s0)}};
  Model model;
  model.bodies.emplace_back("square", square(0, 1), material(), held);
  return model;
}

double relaxed(double t) {
  const double x = SinhDashpot::decayed(s0, M + SinhDashpot::K, t);
  return (x + SinhDashpot::K * s0 / M) / (1 + SinhDashpot::K / M);
}

// Blocks under a pressure p: x = -p - K eps_v, x' = -K A sinh(x/S); both shorten alike.
constexpr double p = 1;
constexpr double atOnce = 1e-12;  // in which they come [s]

Model blocks(bool held) {
  Conditions onTop{{{left, alongX, constant(0)}}, {}, {}};
  if (held)
    onTop.displacements.push_back({top, alongY, [](double, double, double t) {
                                     return -2 * p / elasticity.young * std::min(1.0, t / atOnce);
                                   }});
  else
    onTop.tractions = {{top, alongY, constant(-p)}};
  Body upper("upper", square(0, 2), material(), onTop);
  Body lower("lower", square(-1, 3), material(),
             {{{left, alongX, constant(0)}, {bottom, alongY, constant(0)}}, {}, {}});
  return contactModel(std::move(upper), std::move(lower), CouplingKind::mortar, upperBody);
}

double shortened(double t) {
  const double x = SinhDashpot::decayed(-p, SinhDashpot::K, t);
  return -2 * (p / elasticity.young + (p + x) / SinhDashpot::K);
}

// Held as the pressure leaves them at the start: x' = -(E + K) A sinh(x/S), s = (x - K p/E)/(1 + K/E).
double relaxedAlong(double t) {
  const double x = SinhDashpot::decayed(-p, elasticity.young + SinhDashpot::K, t);
  const double part = SinhDashpot::K / elasticity.young;
  return (x - part * p) / (1 + part);
}

double topOf(const Model& model, const State& state) {
  return displacementRange(model.bodies[0], state.bodies[0], 1, [](const Point& x) { return x.y() == 1; })
      .mean();
}

/// The load acts at once: E^-1 s is there before it creeps.
State loaded(const Model& model) {
  State state = initialState(model);
  const RunReport run =
      march(model, state, {.end = atOnce, .steps = 1}, {}, [](const State&, const StepReport&) {});
  EXPECT_EQ(run.status, Status::converged) << run.reason;
  return state;
}

/// errorOf(state, step report) of a step, summed over the steps.
template <class ErrorOf>
void expectOrders(const char* what, const Model& model, const State& begin, double end, double least,
                  ErrorOf errorOf) {
  for (const Scheme scheme : schemes) {
    std::vector<double> k;
    std::vector<double> errors;
    for (const int steps : {20, 40, 80, 160}) {
      State state = begin;
      MarchMemory memory;
      double sum = 0;
      const RunReport run = march(model, state, memory, {.end = end, .steps = steps, .scheme = scheme}, {},
                                  [&](const State& now, const StepReport& report) {
                                    if (report.step > 0) sum += std::abs(errorOf(now));
                                  });
      ASSERT_EQ(run.status, Status::converged) << run.reason;
      k.push_back(end / steps);
      errors.push_back(sum / steps);
    }
    const double order = fittedOrder(k, errors);
    std::cout << what << ", scheme " << static_cast<int>(scheme) << ": order " << order << ", errors "
              << errors.front() << " ... " << errors.back() << "\n";
    EXPECT_NEAR(order, orderOf(scheme), orderTolerance) << what;
    EXPECT_LE(errors.back(), orderOf(scheme) == 1 ? 5e-3 : least) << what;
  }
}

TEST(OwnLawOrders, aPointRelaxesWithTheOrderOfTheScheme) {
  const Model model = heldSquare();
  expectOrders("point", model, initialState(model), 2, 1e-4, [](const State& now) {
    return now.bodies[0].stress(2, 0) / std::sqrt(2) - relaxed(now.time);
  });
}

TEST(OwnLawOrders, bodiesInContactCreepWithTheOrderOfTheScheme) {
  const Model model = blocks(false);
  expectOrders("bodies", model, loaded(model), 2, 1e-5, [&](const State& now) {
    return (topOf(model, now) - shortened(now.time)) / shortened(now.time);
  });
}

TEST(OwnLawOrders, stepsByTheirErrorKeepTheTolerance) {
  constexpr double tolerance = 1e-3;
  for (const Scheme scheme : {Scheme::backwardEuler, Scheme::sdirk2}) {
    const Model square = heldSquare();
    State held = initialState(square);
    const RunReport relaxing = runWith(square, held, controlled(2, tolerance, scheme));
    ASSERT_EQ(relaxing.status, Status::converged) << relaxing.reason;
    print("point", relaxing);
    const double off = std::abs(held.bodies[0].stress(2, 0) / std::sqrt(2) - relaxed(2)) / s0;
    std::cout << ", error " << off << ", estimate " << relaxing.timeError << "\n";
    EXPECT_LE(off, tolerance);

    const Model pair = blocks(true);
    State squeezed = loaded(pair);
    MarchMemory memory;
    memory.begin = squeezed.time;
    const RunReport pressed = march(pair, squeezed, memory, controlled(2, tolerance, scheme), {},
                                    [](const State&, const StepReport&) {});
    ASSERT_EQ(pressed.status, Status::converged) << pressed.reason;
    print("bodies", pressed);
    const double lost = std::abs(toCartesian(squeezed.bodies[0].stress.col(0))[1] - relaxedAlong(2)) / p;
    std::cout << ", error " << lost << ", estimate " << pressed.timeError << "\n";
    EXPECT_LE(lost, tolerance);
    EXPECT_LT(relaxing.steps + pressed.steps, scheme == Scheme::sdirk2 ? 200 : 4000);
  }
}

// A bar between walls, heated by T = T1 t (1 + t) from a stress beyond yield on: with the overstress
// f = -s - sigma_Y, s' = -E (alpha T' - f/(3 lambda)), so that with 1/tau = E/(3 lambda)
//   f = c0 + c1 t + c2 exp(-t/tau).
TEST(OwnLawOrders, aHeatedBarFlowsWithTheOrderOfTheScheme) {
  constexpr double expansion = 1e-4;
  constexpr double T1 = 100;
  constexpr double first = 2;
  Overstress law{1};
  law.setViscosity(10);
  const double tau = 3 * 10 / elasticity.young;
  const double heat = elasticity.young * expansion * T1;  // E alpha T' = heat (1 + 2 t)
  const double c1 = 2 * heat * tau;
  const double c0 = tau * (heat - c1);
  const double c2 = first - law.yieldStress - c0;
  Conditions conditions{
      {{left, alongX, constant(0)}, {right, alongX, constant(0)}, {bottom, alongY, constant(0)}}, {}, {}};
  conditions.initialStresses = {{0, std::nullopt, constant(-first)}};
  conditions.temperature = [=](double, double, double t) { return T1 * t * (1 + t); };
  conditions.expansion = Eigen::Vector3d(std::sqrt(2) * expansion, 0, 0).replicate(1, 4);
  Model model;
  model.bodies.emplace_back("bar", square(0, 1), overstressMaterial(elasticity, law, Plane::stress),
                            conditions);
  expectOrders("heated bar", model, initialState(model), 1, 2e-4, [&](const State& now) {
    const double f = c0 + c1 * now.time + c2 * std::exp(-now.time / tau);
    return -toCartesian(now.bodies[0].stress.col(0))[0] - law.yieldStress - f;
  });
}

}  // namespace mortier::own_law_orders_test
