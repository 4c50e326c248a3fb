// The work done on bodies is what they store and what they turn into heat: to rounding where they are
// elastic, by an identity of the scheme where they flow, and to its order (docs/theory.md, "Energies").
#include <gtest/gtest.h>

#include <iostream>
#include <numeric>
#include <string>

#include "material/overstress.h"
#include "material/parts.h"
#include "theory/compression.h"
#include "theory/controlled_runs.h"
#include "theory/pressed_blocks.h"
#include "theory/scenes.h"
#include "time/step_taker.h"

namespace mortier::energy_balance_test {

using namespace scenes;
using Kind = Quantity::Kind;

/// Of sums over all triangles and steps, over the largest term of the balance.
constexpr double rounding = 1e-12;

constexpr Scheme schemes[] = {Scheme::backwardEuler, Scheme::crankNicolson, Scheme::sdirk2};

Quantity energyOf(Kind kind, size_t body) {
  return {"energy", kind, static_cast<int>(body)};
}

/// The plan counts work.
TimePlan plan(int steps, Scheme scheme = Scheme::backwardEuler, double end = 1) {
  return {.end = end, .steps = steps, .scheme = scheme, .quantities = {energyOf(Kind::work, 0)}};
}

double valueOf(Kind kind, size_t body, const Model& model, const State& state) {
  return evaluate({energyOf(kind, body)}, model, state)[0];
}

/// What a body has taken up since a state, and what of it is not accounted for.
struct Balance {
  double work = 0;
  double stored = 0;
  double dissipated = 0;
  [[nodiscard]] double defect() const { return work - stored - dissipated; }
};

Balance balanceOf(const Model& model, size_t body, const State& start, const State& end) {
  return {valueOf(Kind::work, body, model, end) - valueOf(Kind::work, body, model, start),
          valueOf(Kind::storedEnergy, body, model, end) - valueOf(Kind::storedEnergy, body, model, start),
          valueOf(Kind::dissipatedEnergy, body, model, end) -
              valueOf(Kind::dissipatedEnergy, body, model, start)};
}

struct States {
  std::vector<State> all;  ///< the first one too
  RunReport report;
  double stored = 0;  ///< the most of all bodies at any time
};

States marched(const Model& model, State start, const TimePlan& plan) {
  States states;
  states.report = march(model, start, plan, {}, [&](const State& now, const StepReport& report) {
    if (report.step == 0) states.all.clear();
    states.all.push_back(now);
    double stored = 0;
    for (size_t b = 0; b < model.bodies.size(); ++b) stored += valueOf(Kind::storedEnergy, b, model, now);
    states.stored = std::max(states.stored, stored);
  });
  EXPECT_EQ(states.report.status, Status::converged) << states.report.reason;
  return states;
}

// Contact opens and closes, the top is moved: whatever the steps, each body has stored what was done on it.
TEST(EnergyBalance, ofElasticBodiesHoldsToRounding) {
  const auto elastic = elasticMaterial({100, 0.3});
  for (const CouplingKind coupling : couplings)
    for (const Scheme scheme : schemes) {
      const Function path = [](double x, double, double t) { return (1 + x) * pathOfTheTop(t); };
      const Function shear = [](double, double, double t) { return 0.3 * std::sin(3 * t); };
      Body upper("upper", square(0, 5), elastic,
                 {{{left, 0, constant(0)}, {top, 1, path}}, {{right, 0, shear}}, {}});
      Body lower("lower", square(-1, 7), elastic,
                 {{{left, 0, constant(0)}, {bottom, 1, constant(0)}}, {}, {{1, constant(-0.1)}}});
      const Model model = contactModel(std::move(upper), std::move(lower), coupling, upperBody);
      const States states = marched(model, initialState(model), plan(13, scheme, 4));
      double worst = 0;
      for (const State& state : states.all)
        for (size_t b = 0; b < 2; ++b) {
          worst = std::max(worst, std::abs(balanceOf(model, b, states.all[0], state).defect()));
          EXPECT_EQ(state.bodies[b].work.dissipated, 0);
        }
      std::cout << nameOf(coupling)
                << ": work - stored, over the most that is stored: " << worst / states.stored << "\n";
      EXPECT_LE(worst, rounding * states.stored);
    }
}

// A load in proportion to time, from rest: 1/2 F . u, which is what loads and supports do on both blocks.
TEST(EnergyBalance, theWorkOfAProportionalLoadIsHalfOfForceTimesWay) {
  const Model model = hardcases::Compression{.upperLaw = {}, .lowerLaw = {}}.model();
  for (const int steps : {1, 7}) {
    const States states = marched(model, initialState(model), plan(steps));
    const State& end = states.all.back();
    double half = 0;
    double external = 0;
    for (size_t b = 0; b < 2; ++b) {
      half += model.bodies[b].load(1).dot(end.bodies[b].displacement) / 2;
      external += end.bodies[b].work.external;
    }
    EXPECT_NEAR(external, half, rounding * half) << steps << " steps";
    EXPECT_NEAR(half, states.stored, rounding * half);
    EXPECT_NEAR(end.bodies[0].work.contact + end.bodies[1].work.contact, 0, rounding * half);
  }
}

TEST(EnergyBalance, contactDoesNoWorkWhereItChangesWithinAStep) {
  const Model model = pressedBlocks(CouplingKind::mortar);
  const States states = marched(model, initialState(model), plan(29, Scheme::backwardEuler, 4));
  int changes = 0;
  for (size_t i = 1; i < states.all.size(); ++i) {
    const Vector& p0 = states.all[i - 1].contactForce[0];
    const Vector& p1 = states.all[i].contactForce[0];
    if (p1.dot(states.all[i - 1].gap[0]) != p0.dot(states.all[i].gap[0])) ++changes;
    double found = 0;
    for (const BodyState& body : states.all[i].bodies) found += body.work.contact;
    EXPECT_NEAR(found, 0, rounding * states.stored) << "step " << i;
  }
  EXPECT_EQ(changes, 2);
}

// Two squares, E = 100, a third of whose approach closes the gap: s = 1, U = s^2/(2 E) each. Supports of the
// one that moves do what both store; they get it back when contact opens, in one step each.
TEST(EnergyBalance, nothingIsDoneWhileAGapCloses) {
  const auto elastic = elasticMaterial({100, 0.3});
  const Function way = [](double, double, double t) { return -0.03 * std::min(t, 2 - t); };
  InterfaceOptions options;
  options.gap = still([](const Point&) { return 0.01; });
  for (const int nonmortar : {upperBody, lowerBody}) {
    Body upper("upper", square(0, 3), elastic, {{{left, 0, constant(0)}, {top, 1, way}}, {}, {}});
    Body lower("lower", square(-1, 4), elastic, {{{left, 0, constant(0)}, {bottom, 1, constant(0)}}, {}, {}});
    const Model model =
        contactModel(std::move(upper), std::move(lower), CouplingKind::mortar, nonmortar, options);
    const States states = marched(model, initialState(model), plan(2, Scheme::backwardEuler, 2));
    ASSERT_EQ(states.all.size(), 3);
    for (const int end : {1, 2}) {
      const std::vector<BodyState>& bodies = states.all[end].bodies;
      EXPECT_NEAR(bodies[upperBody].work.external, end == 1 ? 0.01 : 0, rounding);
      EXPECT_NEAR(bodies[lowerBody].work.external, 0, rounding);
      EXPECT_NEAR(bodies[lowerBody].work.contact, end == 1 ? 0.005 : 0, rounding);
    }
  }
}

TEST(EnergyBalance, startsFromTheInitialStress) {
  Conditions conditions;
  conditions.displacements = {{bottom, 1, constant(0)}, {left, 0, constant(0)}};
  conditions.tractions = {{top, 1, [](double, double, double t) { return -3 - 5 * t; }}};
  conditions.initialStresses = {{1, std::nullopt, constant(-3)}};
  Model model;
  model.bodies.emplace_back("square", square(0, 3), elasticMaterial({100, 0.3}), conditions);
  const States states = marched(model, initialState(model), plan(2));
  // U = s^2/(2 E): from 9/200 to 64/200, by a mean force of 5.5 on a way of 5/100.
  EXPECT_NEAR(valueOf(Kind::storedEnergy, 0, model, states.all[0]), 0.045, 1e-14);
  EXPECT_NEAR(valueOf(Kind::storedEnergy, 0, model, states.all.back()), 0.32, 1e-14);
  EXPECT_NEAR(valueOf(Kind::externalWork, 0, model, states.all.back()), 0.275, 1e-14);
}

/// sum |T| a : b
double product(const Body& body, const Matrix& a, const Matrix& b) {
  double sum = 0;
  for (int i = 0; i < body.points(); ++i) sum += body.weights()[i] * a.col(i).dot(b.col(i));
  return sum;
}

// Backward Euler: work - stored - dissipated = -1/2 sum of ds : de, step by step, also where steps are
// chosen by their error and some of them rejected.
TEST(EnergyBalance, ofBackwardEulerLacksHalfOfStressTimesFlow) {
  const Model model = pressedBlocks(CouplingKind::mortar);
  TimePlan plans[] = {plan(20, Scheme::backwardEuler, 4), plan(2, Scheme::backwardEuler, 4)};
  plans[1].tolerance = 0.005;
  for (const TimePlan& each : plans) {
    const States states = marched(model, initialState(model), each);
    EXPECT_EQ(states.report.rejected > 0, each.tolerance > 0);
    double dissipated = 0;
    for (size_t i = 1; i < states.all.size(); ++i)
      for (size_t b = 0; b < 2; ++b) {
        const BodyState& before = states.all[i - 1].bodies[b];
        const BodyState& after = states.all[i].bodies[b];
        const Balance balance = balanceOf(model, b, states.all[i - 1], states.all[i]);
        const double lack = -product(model.bodies[b], after.stress - before.stress,
                                     after.viscoplasticStrain - before.viscoplasticStrain) /
                            2;
        EXPECT_NEAR(balance.defect(), lack, rounding * states.stored) << "step " << i;
        EXPECT_GE(balance.dissipated, -rounding * states.stored);
        dissipated += balance.dissipated;
      }
    EXPECT_GT(dissipated, 0.1 * states.stored);
  }
}

// Crank-Nicolson: -1/4 sum of k ds : dG.
TEST(EnergyBalance, ofCrankNicolsonLacksAQuarterOfStressTimesRate) {
  const Model model = pressedBlocks(CouplingKind::mortar);
  const States states = marched(model, initialState(model), plan(40, Scheme::crankNicolson, 2));
  for (size_t i = 1; i < states.all.size(); ++i)
    for (size_t b = 0; b < 2; ++b) {
      const Body& body = model.bodies[b];
      const Matrix& s0 = states.all[i - 1].bodies[b].stress;
      const Matrix& s1 = states.all[i].bodies[b].stress;
      Matrix rate0;
      Matrix rate1;
      body.material().viscoplasticRate(s0, rate0);
      body.material().viscoplasticRate(s1, rate1);
      const double k = states.all[i].time - states.all[i - 1].time;
      EXPECT_NEAR(balanceOf(model, b, states.all[i - 1], states.all[i]).defect(),
                  -k / 4 * product(body, s1 - s0, rate1 - rate0), 1e-9 * states.stored)
          << "step " << i;
    }
}

// The note's test, on steps that land on first yield.
TEST(EnergyBalance, ofBodiesThatFlowIsOfTheOrderOfTheScheme) {
  const Model model = compression(2, 3, perzynaMaterial(noteElasticity, noteLaw(Projection::elasticity)),
                                  CouplingKind::mortar, upperBody);
  for (const Scheme scheme : schemes) {
    std::vector<double> k;
    std::vector<double> defects;
    for (const int steps : {40, 80, 160, 320}) {
      const States states = marched(model, initialState(model), plan(steps, scheme));
      const Balance whole = balanceOf(model, 0, states.all.front(), states.all.back());
      EXPECT_GT(whole.dissipated, 0.1 * whole.work);
      k.push_back(1.0 / steps);
      defects.push_back(std::abs(whole.defect()) / whole.work);
    }
    const double order = fittedOrder(k, defects);
    std::cout << "order " << order << ", work - stored - dissipated over work";
    for (const double defect : defects) std::cout << " " << defect;
    std::cout << "\n";
    EXPECT_NEAR(order, scheme == Scheme::backwardEuler ? 1 : 2, 0.1);
  }
}

// A square that is held under a stress beyond yield: what it loses is what it dissipates, no work is done.
TEST(EnergyBalance, relaxationTurnsWhatWasStoredIntoHeat) {
  Conditions held;
  for (const int side : {bottom, right, top, left})
    for (const int component : {0, 1}) held.displacements.push_back({side, component, constant(0)});
  Model model;
  model.bodies.emplace_back("square", square(0, 2), perzynaMaterial({10, 0.3}, {1, 1, Projection::frobenius}),
                            held);
  State begin = initialState(model);
  begin.bodies[0].stress.colwise() = fromCartesian({2, 2, 0});
  for (const Scheme scheme : schemes) {
    std::vector<double> k;
    std::vector<double> defects;
    for (const int steps : {100, 200, 400}) {
      const States states = marched(model, begin, plan(steps, scheme, 3));
      const Balance whole = balanceOf(model, 0, states.all.front(), states.all.back());
      EXPECT_NEAR(whole.work, 0, rounding * states.stored);
      EXPECT_GT(whole.dissipated, 0.1);
      k.push_back(3.0 / steps);
      defects.push_back(std::abs(whole.dissipated + whole.stored));
    }
    EXPECT_NEAR(fittedOrder(k, defects), scheme == Scheme::backwardEuler ? 1 : 2, 0.1);
  }
}

// Plasticity with kinematic hardening, pulled, unloaded and pushed back by steps that end where it yields and
// where the course turns: what is not in one of the two springs is sigma_Y times the plastic strain so far.
TEST(EnergyBalance, ofKinematicHardeningIsExactOnStraightPaths) {
  constexpr double E = 100;
  constexpr double H = 20;
  Overstress law{1};
  law.kinematicHardening = H;
  constexpr double strains[] = {0, 0.01, 0.03, 0.01, -0.01};
  const Function course = [&](double, double, double t) {
    const int i = std::min(3, static_cast<int>(t));
    return strains[i] + (t - i) * (strains[i + 1] - strains[i]);
  };
  Conditions pulled{
      {{left, alongX, constant(0)}, {bottom, alongY, constant(0)}, {top, alongY, course}}, {}, {}};
  for (const bool regions : {false, true}) {
    const auto material = overstressMaterial({E, 0.3}, law, Plane::stress);
    Model model;
    model.bodies.emplace_back("bar", square(0, 1),
                              regions ? materialOfParts({material, material}, {0, 1, 0, 1}) : material,
                              pulled);
    const States states = marched(model, initialState(model), plan(4, Scheme::backwardEuler, 4));
    const double rate = 1 / (1 + H / E);  // of the plastic strain where it flows
    const double flowed[] = {0, 0, 0.02 * rate, 0.02 * rate, 0};
    const double all[] = {0, 0, 0.02 * rate, 0.02 * rate, 0.04 * rate};
    for (size_t i = 1; i < states.all.size(); ++i) {
      const Balance balance = balanceOf(model, 0, states.all.front(), states.all[i]);
      const double s = E * (strains[i] - flowed[i]);
      EXPECT_NEAR(balance.stored, s * s / (2 * E) + H * flowed[i] * flowed[i] / 2, 1e-11 * states.stored)
          << i;
      EXPECT_NEAR(balance.dissipated, law.yieldStress * all[i], 1e-11 * states.stored) << i;
      EXPECT_NEAR(balance.defect(), 0, 1e-11 * states.stored) << i;
    }
  }
}

// With a power of the overstress too it is of the order of the scheme, and nothing cools.
TEST(EnergyBalance, ofViscoplasticHardeningIsOfTheOrderOfTheScheme) {
  Overstress law{1, 0.5, 0.01, 3, 15, 20};
  Conditions pulled{{{left, alongX, constant(0)},
                     {bottom, alongY, constant(0)},
                     {top, alongY, [](double, double, double t) { return 0.01 * t * (1 + t); }}},
                    {},
                    {}};
  pulled.initialStresses = {{1, std::nullopt, constant(2)}};
  Model model;
  model.bodies.emplace_back("bar", square(0, 1), overstressMaterial({100, 0.3}, law, Plane::stress), pulled);
  for (const Scheme scheme : schemes) {
    std::vector<double> k;
    std::vector<double> defects;
    for (const int steps : {160, 320, 640, 1280}) {
      const States states = marched(model, initialState(model), plan(steps, scheme));
      for (size_t i = 1; i < states.all.size(); ++i)
        EXPECT_GE(balanceOf(model, 0, states.all[i - 1], states.all[i]).dissipated, 0);
      k.push_back(1.0 / steps);
      defects.push_back(std::abs(balanceOf(model, 0, states.all.front(), states.all.back()).defect()));
    }
    std::cout << "order " << fittedOrder(k, defects) << ", defects " << defects.front() << " ... "
              << defects.back() << "\n";
    EXPECT_NEAR(fittedOrder(k, defects), scheme == Scheme::backwardEuler ? 1 : 2, 0.15);
  }
}

// What was tried and not taken counts nothing; a run that goes on counts on.
TEST(EnergyBalance, countsStepsThatAreTakenOnly) {
  const Model model = pressedBlocks(CouplingKind::mortar);
  const auto counted = [&](bool hesitates) {
    State state = initialState(model);
    MarchMemory memory;
    StepTaker taker(model, state, memory, Scheme::sdirk2, {}, true);
    for (int step = 1; step <= 5; ++step) {
      memory.increments.clear();  // the same first guesses
      if (hesitates) {
        EXPECT_TRUE(taker.attempt(0.2 * step + 0.7).converged());
        memory.increments.clear();
      }
      EXPECT_TRUE(taker.attempt(0.2 * step).converged());
      taker.commit();
    }
    return state.bodies[0].work;
  };
  const WorkDone straight = counted(false);
  const WorkDone hesitant = counted(true);
  EXPECT_GT(straight.dissipated, 0);
  EXPECT_NEAR(hesitant.external, straight.external, 1e-9 * straight.external);
  EXPECT_NEAR(hesitant.dissipated, straight.dissipated, 1e-9 * straight.external);
}

TEST(EnergyBalance, isNotCountedWhereNobodyAsks) {
  const Model model = pressedBlocks(CouplingKind::mortar);
  State state = initialState(model);
  TimePlan silent = plan(4);
  silent.quantities = {energyOf(Kind::storedEnergy, 0)};
  march(model, state, silent, {}, [](const State&, const StepReport&) {});
  EXPECT_EQ(state.bodies[0].work.external, 0);
  EXPECT_GT(valueOf(Kind::storedEnergy, 0, model, state), 0);
}

}  // namespace mortier::energy_balance_test
