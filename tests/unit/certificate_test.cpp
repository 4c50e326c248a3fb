// What a certificate shows of a step that is not solved.
#include <gtest/gtest.h>

#include <cmath>
#include <limits>

#include "material/perzyna.h"
#include "mesh/generate.h"
#include "solver/solve_step.h"
#include "time/march.h"
#include "time/measure.h"

namespace mortier::certificate_test {

constexpr double nan = std::numeric_limits<double>::quiet_NaN();

Function constant(double value) {
  return [value](double, double, double) { return value; };
}

/// Two elastic squares, the upper one pressed on the lower one; apart and each held by itself without
/// contact.
Model squares(bool contact, double upperLoad = -1, double lowerLoad = 0) {
  const auto material = elasticMaterial({100, 0.3});
  Model model;
  model.bodies.emplace_back("upper", crissCrossMesh({{0, 0}, {1, 1}, 2, 2}), material,
                            Conditions{{{4, alongX, constant(0)}}, {{3, alongY, constant(upperLoad)}}, {}});
  model.bodies.emplace_back(
      "lower", crissCrossMesh({{0, -1}, {1, 0}, 3, 3}), material,
      Conditions{
          {{4, alongX, constant(0)}, {1, alongY, constant(0)}}, {{2, alongX, constant(lowerLoad)}}, {}});
  if (contact) {
    addInterface(model, {{0, 1}, {1, 3}, CouplingKind::mortar});
  } else {
    // The upper one stands by itself.
    model.bodies[0] =
        Body("upper", crissCrossMesh({{0, 0}, {1, 1}, 2, 2}), material,
             {{{4, alongX, constant(0)}, {1, alongY, constant(0)}}, {{3, alongY, constant(upperLoad)}}, {}});
  }
  return model;
}

struct Solved {
  Model model = squares(true);
  State state0 = initialState(model);
  StepSystem system{model, {}};
  StepData data{1, 1, {}};
  Iterate iterate = startingIterate(state0);
  StepOutcome outcome = solveStep(system, state0, data, iterate);
  std::vector<Vector> loads{model.bodies[0].load(1), model.bodies[1].load(1)};

  [[nodiscard]] Certificate certificate() const {
    return system.certify({state0, data, loads, {}}, iterate, 0);
  }
};

TEST(Certificate, ofASolutionIsRounding) {
  const Solved solved;
  ASSERT_TRUE(solved.outcome.converged());
  const Certificate found = solved.certificate();
  EXPECT_LE(found.forceBalance, 1e-13);
  EXPECT_LE(found.gapOnActive, 1e-15);
  EXPECT_LE(found.sign, 1e-15);
  EXPECT_LE(found.complementarity, 1e-15);
  EXPECT_EQ(found.openPenetration, 0);
  EXPECT_GT(found.rounding, 0);
  EXPECT_LE(found.rounding, 1e-13);
}

// The rounding of displacements is taken over the stresses that are there, and this body has none.
TEST(Certificate, hasNoRoundingOfABodyThatWasMovedAndIsFreeOfStress) {
  const Model model = squares(false, 0);
  State state0 = initialState(model);
  for (BodyState& body : state0.bodies) body.displacement.setConstant(0.1);
  StepSystem system(model, {});
  const StepData data{1, 1, {}};
  const Step step = system.step(state0, data);
  Iterate iterate = startingIterate(state0);
  const double residual = system.linearise(step, iterate, data.weight, false).residual();
  EXPECT_EQ(system.certify(step, iterate, residual).rounding, 0);
}

TEST(Certificate, showsForcesThatPulledBeforeTheyWereSetToZero) {
  Solved solved;
  solved.iterate.largestTension = 0.1;
  EXPECT_NEAR(solved.certificate().sign, 0.1 / 0.5,
              1e-12);  // the largest nodal force is that of the load, 1/2
}

TEST(Certificate, showsPenetrationOfNodesThatAreNotActive) {
  Solved solved;
  solved.iterate.active[0][1] = 0;
  const int node = solved.model.interfaces[0].nonmortarNodes()[1];
  solved.iterate.bodies[0].increment.high[2 * node + 1] -= 0.05;
  // Over the extent of the bodies, which is 1.
  EXPECT_NEAR(solved.certificate().openPenetration, 0.05, 1e-12);
}

TEST(Certificate, keepsEveryNaN) {
  const auto spoilt = [](auto spoil) {
    Solved solved;
    spoil(solved);
    return solved.certificate();
  };
  EXPECT_TRUE(std::isnan(
      spoilt([](Solved& s) { s.loads[0][0] = s.loads[0][1] = s.loads[0][17] = nan; }).forceBalance));
  for (const int body : {0, 1}) {
    EXPECT_TRUE(
        std::isnan(spoilt([&](Solved& s) { s.iterate.bodies[body].stress(1, 3) = nan; }).forceBalance));
    EXPECT_TRUE(std::isnan(
        spoilt([&](Solved& s) { s.iterate.bodies[body].increment.low.setConstant(nan); }).gapOnActive));
  }
  EXPECT_TRUE(std::isnan(spoilt([](Solved& s) { s.iterate.contactForce[0][0] = nan; }).complementarity));
  Certificate one;
  one.sign = one.rounding = one.openPenetration = nan;
  for (const Certificate& both : {worse(one, {}), worse({}, one)}) {
    EXPECT_TRUE(std::isnan(both.sign));
    EXPECT_TRUE(std::isnan(both.rounding));
    EXPECT_TRUE(std::isnan(both.openPenetration));
  }
}

// The residual of the other body is no answer.
TEST(Certificate, aBodyWithoutANumberIsNotSolved) {
  for (const bool first : {true, false}) {
    const Model model = squares(false, first ? nan : -1, first ? 0 : nan);
    StepSystem system(model, {});
    const State state0 = initialState(model);
    Iterate iterate = startingIterate(state0);
    const StepOutcome outcome = solveStep(system, state0, {1, 1, {}}, iterate);
    EXPECT_FALSE(outcome.converged()) << (first ? "first" : "second");
  }
}

}  // namespace mortier::certificate_test
