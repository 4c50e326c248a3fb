// What a run leaves out changes nothing: with every reduction the fields are those of the full model, which
// factorises in every iteration, solves every step and takes the general solver.
#include <gtest/gtest.h>

#include <iostream>

#include "material/interior_path.h"
#include "theory/scenes.h"

namespace mortier::reductions_test {

using namespace scenes;

constexpr double same = 1e-10;

/// Elastic strains are no smaller than what flows: stresses are known to as many digits as displacements.
constexpr Elasticity soft{100, 0.3};

struct Counted {
  State state;
  RunReport report;
};

Counted solve(const Model& model, TimePlan plan, bool reduce) {
  Counted result{initialState(model), {}};
  SolverOptions options;
  options.reduce = reduce;
  result.report = march(model, result.state, plan, options, [](const State&, const StepReport&) {});
  EXPECT_EQ(result.report.status, Status::converged) << result.report.reason;
  return result;
}

void expectSame(const Matrix& a, const Matrix& b, const char* what) {
  ASSERT_EQ(a.size(), b.size());
  EXPECT_LE((a - b).lpNorm<Eigen::Infinity>(), same * b.lpNorm<Eigen::Infinity>()) << what;
}

void expectSameFields(const State& a, const State& b) {
  for (size_t body = 0; body < b.bodies.size(); ++body) {
    expectSame(a.bodies[body].displacement, b.bodies[body].displacement, "displacement");
    expectSame(a.bodies[body].stress, b.bodies[body].stress, "stress");
    expectSame(a.bodies[body].viscoplasticStrain, b.bodies[body].viscoplasticStrain, "viscoplastic strain");
  }
  for (size_t k = 0; k < b.contactForce.size(); ++k)
    expectSame(a.contactForce[k], b.contactForce[k], "contact force");
}

struct Both {
  RunReport reduced;
  RunReport full;
};

Both solveBoth(const Model& model, const TimePlan& plan) {
  const Counted reduced = solve(model, plan, true);
  const Counted full = solve(model, plan, false);
  expectSameFields(reduced.state, full.state);
  EXPECT_EQ(reduced.report.steps, full.report.steps);
  std::cout << reduced.report.factorisations << " factorisations instead of " << full.report.factorisations
            << ", " << reduced.report.iterations << " linear solves instead of " << full.report.iterations
            << '\n';
  return {reduced.report, full.report};
}

/// A block on a block, pressed by `traction` where x < 0.7: contact opens beside it.
Model pressed(const Function& traction, const std::shared_ptr<const Material>& upper,
              const std::shared_ptr<const Material>& lower) {
  const Function part = [traction](double x, double y, double t) { return x < 0.7 ? traction(x, y, t) : 0; };
  Body above("upper", square(0, 5), upper, {{{left, 0, constant(0)}}, {{top, 1, part}}, {}});
  Body below("lower", square(-1, 8), lower, {{{left, 0, constant(0)}, {bottom, 1, constant(0)}}, {}, {}});
  return contactModel(std::move(above), std::move(below), CouplingKind::mortar, upperBody);
}

std::shared_ptr<const Material> flowing(double yieldStress, Projection projection = Projection::frobenius) {
  return perzynaMaterial(soft, {1, yieldStress, projection});
}

Function ramp(double rate) {
  return [rate](double, double, double t) { return -rate * t; };
}

TEST(Reductions, elasticBodiesKeepOneFactor) {
  const auto elastic = elasticMaterial(soft);
  const Function changing = [](double x, double, double t) { return -1 - std::sin(5 * t) * (x - 0.3); };
  const Both runs = solveBoth(pressed(changing, elastic, elastic), {.end = 1, .steps = 12});
  EXPECT_EQ(runs.reduced.factorisations, 2);
  EXPECT_EQ(runs.full.factorisations, 2 * runs.full.iterations);
}

TEST(Reductions, bodiesThatNeverYieldStayLinear) {
  for (const Projection projection : {Projection::frobenius, Projection::elasticity}) {
    const Both runs = solveBoth(pressed(ramp(10), flowing(1, projection), flowing(1e3, projection)),
                                {.end = 1, .steps = 10});
    // The lower body once; the upper one in every iteration once it flows.
    EXPECT_GT(runs.reduced.iterations, 10);
    EXPECT_LE(runs.reduced.factorisations, runs.full.iterations + 1);
    EXPECT_EQ(runs.full.factorisations, 2 * runs.full.iterations);
  }
}

TEST(Reductions, bodiesThatYieldAndComeBackAreReinstated) {
  const Function cycle = [](double, double, double t) { return -2 * std::pow(std::sin(3 * t), 2); };
  for (const Scheme scheme : {Scheme::backwardEuler, Scheme::sdirk2}) {
    const Both runs =
        solveBoth(pressed(cycle, flowing(1), flowing(1)), {.end = 2, .steps = 40, .scheme = scheme});
    EXPECT_LT(runs.reduced.factorisations, 0.9 * runs.full.factorisations);
    EXPECT_GT(runs.reduced.factorisations, 20);
  }
}

TEST(Reductions, oneStepIsSolvedWhereNothingDependsOnTime) {
  const auto elastic = elasticMaterial(soft);
  const Both runs = solveBoth(pressed(constant(-1), elastic, elastic), {.end = 1, .steps = 50});
  EXPECT_EQ(runs.reduced.rungs.at("rest"), 50);  // the load acts before the first step
  EXPECT_EQ(runs.reduced.factorisations, 2);
  EXPECT_GE(runs.full.iterations, 50);
  EXPECT_EQ(runs.full.rungs.count("rest"), 0);
  EXPECT_LT(runs.reduced.worst.forceBalance, 1e-12);
}

// Held below yield, then beyond it, where it flows on.
TEST(Reductions, holdsAreAtRestUnlessSomethingFlows) {
  const Function holds = [](double, double, double t) {
    return -0.5 * std::min(t, 1.0) - std::clamp(t - 2, 0.0, 1.0);
  };
  for (const Scheme scheme : {Scheme::backwardEuler, Scheme::sdirk2}) {
    const Both runs =
        solveBoth(pressed(holds, flowing(1), flowing(1)), {.end = 4, .steps = 40, .scheme = scheme});
    EXPECT_EQ(runs.reduced.rungs.at("rest"), 10);
  }
}

TEST(Reductions, restUnderErrorControl) {
  const Function hold = [](double, double, double t) { return -std::min(t, 1.0); };
  const auto elastic = elasticMaterial(soft);
  const TimePlan plan{
      .end = 1000, .steps = 10000, .scheme = Scheme::sdirk2, .tolerance = 1e-4, .breaks = {1}};
  const Both runs = solveBoth(pressed(hold, elastic, elastic), plan);
  EXPECT_GE(runs.reduced.rungs.at("rest"), 1);
  EXPECT_LT(runs.reduced.iterations, runs.full.iterations);
}

// Prescribed motions count as well as loads.
TEST(Reductions, movedSupportsAreNotAtRest) {
  const auto elastic = elasticMaterial(soft);
  const Function down = [](double, double, double t) { return -1e-3 * std::min(t, 0.5); };
  Body above("upper", square(0, 5), elastic, {{{left, 0, constant(0)}, {top, 1, down}}, {}, {}});
  Body below("lower", square(-1, 8), elastic, {{{left, 0, constant(0)}, {bottom, 1, constant(0)}}, {}, {}});
  const Model model = contactModel(std::move(above), std::move(below), CouplingKind::mortar, upperBody);
  const Both runs = solveBoth(model, {.end = 1, .steps = 10});
  EXPECT_EQ(runs.reduced.rungs.at("rest"), 5);
}

// Nothing loads the bodies, but they overlap as meshed: the state at t = 0 solves no step.
TEST(Reductions, anOverlapActsBeforeTheFirstStep) {
  const auto elastic = elasticMaterial(soft);
  Body above("upper", square(0, 5), elastic, {{{left, 0, constant(0)}, {top, 1, constant(0)}}, {}, {}});
  Body below("lower", square(-0.999, 8), elastic,
             {{{left, 0, constant(0)}, {bottom, 1, constant(0)}}, {}, {}});
  const Model model = contactModel(std::move(above), std::move(below), CouplingKind::mortar, upperBody);
  const Counted parted = solve(model, {.end = 1, .steps = 3}, true);
  EXPECT_GT(parted.state.contactForce[0].sum(), 0.01);
  EXPECT_EQ(parted.report.rungs.at("rest"), 3);
  solveBoth(model, {.end = 1, .steps = 3});
}

// Flow that a step hardly shows, less than its tolerance, is solved for all the same.
TEST(Reductions, slowFlowIsNoRest) {
  const auto slow = perzynaMaterial(soft, {1e13, 1, Projection::frobenius});
  const Both runs = solveBoth(pressed(constant(-2), slow, slow), {.end = 1, .steps = 10});
  EXPECT_EQ(runs.reduced.rungs.count("rest"), 0);
}

/// A symmetric law for which the general factorisation is taken.
class Unsymmetric : public PerzynaLaw<3> {
 public:
  using PerzynaLaw::PerzynaLaw;
  [[nodiscard]] static bool symmetric() { return false; }
};

TEST(Reductions, symmetricFactorsServeSymmetricLaws) {
  const Eigen::Array3d e = soft.moduli();
  const auto general =
      pointMaterial(Unsymmetric({e[0], e[1]}, {0.5, 1.5}, {1, 1}, {1, 1, Projection::frobenius}), {});
  const Counted cholesky = solve(pressed(ramp(10), flowing(1), flowing(1)), {.end = 1, .steps = 10}, true);
  const Model model = pressed(ramp(10), general, general);
  ASSERT_FALSE(model.bodies[0].pattern().symmetric);
  expectSameFields(cholesky.state, solve(model, {.end = 1, .steps = 10}, true).state);
}

// A body of the scene that nothing touches is the body of a scene of its own, with nothing to condense.
TEST(Reductions, oneBodyNeedsNoContact) {
  const auto block = [](const char* name, double y) {
    return Body(name, square(y, 5), flowing(1),
                {{{left, 0, constant(0)}, {bottom, 1, constant(0)}}, {{top, 1, ramp(3)}}, {}});
  };
  Model alone;
  alone.bodies.push_back(block("upper", 1));
  const Model apart = contactModel(block("upper", 1), block("lower", -1), CouplingKind::mortar, upperBody);
  const State one = solve(alone, {.end = 1, .steps = 10}, true).state;
  State two = solve(apart, {.end = 1, .steps = 10}, true).state;
  EXPECT_EQ(two.contactForce[0].maxCoeff(), 0);
  two.contactForce.clear();
  two.bodies.pop_back();
  expectSameFields(one, two);
}

}  // namespace mortier::reductions_test
