// The guaranteed bound of the error in time of bodies that flow: against an exact solution, and against much
// shorter steps.
#include "bound/flow_bound.h"

#include <gtest/gtest.h>

#include <iostream>
#include <random>

#include "material/deviatoric.h"
#include "theory/scenes.h"

namespace mortier::flow_bound_test {

using namespace scenes;

struct Bounded {
  State state;
  FlowBound bound;
};

Bounded boundedRun(const Model& model, const TimePlan& plan) {
  Bounded result{initialState(model), {}};
  FlowBoundMemory memory;
  FlowBoundRecord record(model, {plan.scheme == Scheme::backwardEuler, plan.controlled()}, result.state,
                         memory);
  const RunReport report =
      march(model, result.state, plan, {},
            [&](const State& state, const StepReport& step) { record.add(state, step); });
  EXPECT_EQ(report.status, Status::converged);
  result.bound = record.atEnd(result.state);
  return result;
}

/// ||eps_p - other|| over the bodies.
double strainBetween(const Model& model, const State& state, const State& other) {
  double sum = 0;
  for (size_t b = 0; b < model.bodies.size(); ++b)
    for (int i = 0; i < model.bodies[b].points(); ++i)
      sum += model.bodies[b].weights()[i] *
             (state.bodies[b].viscoplasticStrain.col(i) - other.bodies[b].viscoplasticStrain.col(i))
                 .squaredNorm();
  return std::sqrt(sum);
}

/// |s - other|
double stressBetween(const Model& model, const State& state, const State& other) {
  double sum = 0;
  for (size_t b = 0; b < model.bodies.size(); ++b) {
    const Matrix off = state.bodies[b].stress - other.bodies[b].stress;
    Matrix elastic;
    model.bodies[b].material().elasticStrain(off, elastic);
    for (int i = 0; i < model.bodies[b].points(); ++i)
      sum += model.bodies[b].weights()[i] * off.col(i).dot(elastic.col(i));
  }
  return std::sqrt(sum);
}

// ---- an exact solution: the note's test, where the stress is -10 t e_y e_y
TEST(FlowBound, isAboveAndNearTheErrorOfTheNotesTest) {
  const auto material = perzynaMaterial(noteElasticity, noteLaw(Projection::frobenius));
  // Flow from t = 0.1 on, by Simpson's rule.
  Vector exact = Vector::Zero(3);
  constexpr int parts = 20000;
  const auto rate = [&](double t) {
    Matrix g;
    material->viscoplasticRate(fromCartesian({0, -10 * t, 0}), g);
    return Vector(g.col(0));
  };
  for (int i = 0; i < parts; ++i) {
    const double h = 0.9 / parts;
    const double t = 0.1 + i * h;
    exact += h / 6 * (rate(t) + 4 * rate(t + h / 2) + rate(t + h));
  }
  const Model model = compression(2, 3, material, CouplingKind::mortar, upperBody);
  for (const int steps : {5, 10, 20, 100, 1000}) {
    const auto [state, bound] = boundedRun(model, {.end = 1, .steps = steps});
    ASSERT_EQ(bound.obstacle, "");
    ASSERT_EQ(bound.moved, "");
    State flowed = state;
    for (BodyState& body : flowed.bodies) body.viscoplasticStrain.colwise() = exact;
    const double over = bound.strain / strainBetween(model, state, flowed);
    std::cout << steps << " steps: bound over error of the viscoplastic strain " << over
              << ", whatever contact does " << bound.factor * over << "\n";
    EXPECT_GE(over, 1);
    EXPECT_LE(over, 1.25);
    EXPECT_LE(bound.data, 1e-12);
    // Forces grow ten times since the first flow; where that comes in the first step, from nothing.
    if (steps == 5)
      EXPECT_TRUE(std::isinf(bound.factor));
    else
      EXPECT_NEAR(bound.factor, std::sqrt(10), 0.01);
  }
}

// ---- much shorter steps
TEST(FlowBound, isAboveTheDistanceFromMuchShorterSteps) {
  for (const Plane plane : {Plane::stress, Plane::strain})
    for (const double young : {3e11, 1e3, 50.0}) {
      const Elasticity elasticity{young, 0.3};
      const auto material = plane == Plane::strain
                                ? perzynaMaterial(elasticity, noteLaw(Projection::elasticity), Plane::strain)
                                : perzynaMaterial(elasticity, noteLaw(Projection::frobenius));
      const Model model = compression(2, 3, material, CouplingKind::interpolation, upperBody);
      const Bounded coarse = boundedRun(model, {.end = 1, .steps = 16});
      const Bounded fine = boundedRun(model, {.end = 1, .steps = 1024});
      ASSERT_EQ(coarse.bound.obstacle + coarse.bound.moved + fine.bound.obstacle + fine.bound.moved, "");
      const double strain = strainBetween(model, coarse.state, fine.state);
      const double stress = stressBetween(model, coarse.state, fine.state);
      std::cout << "E = " << young << ": bound over distance " << coarse.bound.strain / strain
                << " (viscoplastic strain), " << coarse.bound.stress / stress << " (stress)\n";
      EXPECT_LE(strain, coarse.bound.strain + fine.bound.strain);
      EXPECT_LE(coarse.bound.strain, 3 * strain);
      EXPECT_LE(stress, coarse.bound.stress + fine.bound.stress);
      EXPECT_NEAR(coarse.bound.strainNorm, strainBetween(model, coarse.state, initialState(model)),
                  1e-12 * coarse.bound.strainNorm);
    }
}

// ---- one step of given stresses
struct OneStep {
  Model model;
  State before, after;
  FlowBoundMemory memory;
  explicit OneStep(Projection projection = Projection::frobenius) {
    const auto material = perzynaMaterial({1, 0.3}, noteLaw(projection));
    model = compression(1, 1, material, CouplingKind::mortar, upperBody);
    before = after = initialState(model);
    after.time = 0.5;
  }
  FlowBound bound(Steps steps = {}, int rejections = 0) {
    FlowBoundRecord record(model, steps, before, memory);
    record.add(initialState(model), {});
    StepReport report;
    report.step = 1;
    if (before.time > 0) record.add(before, report);
    report.rejections = rejections;
    report.step = 2;
    record.add(after, report);
    return record.atEnd(after);
  }
  void stress(State& state, const Eigen::Vector3d& s) {
    for (BodyState& body : state.bodies) body.stress.colwise() = s;
  }
  /// Bodies that flow in a step that begins with forces and gaps.
  void flow() {
    before.time = 0.25;
    stress(after, {3, -2, 1});
    for (State* state : {&before, &after}) {
      state->contactForce[0].setConstant(2);
      state->gap[0].setZero();
    }
  }
};

TEST(FlowBound, ofAStepIsAboveTheIntegralAndBelowThatOfTheSquare) {
  const auto material = perzynaMaterial({1, 0.3}, noteLaw(Projection::frobenius));
  const auto rate = [&](const Eigen::Vector3d& s) -> Eigen::Vector3d {
    Matrix g;
    material->viscoplasticRate(Matrix(s), g);
    return g.col(0);
  };
  constexpr double viscosity = 10;
  std::mt19937 random(3);
  std::normal_distribution<double> normal;
  const auto draw = [&] { return Eigen::Vector3d(normal(random), normal(random), normal(random)); };
  bool sharper = false;
  for (int i = 0; i < 200; ++i) {
    OneStep step;
    const bool straight =
        i == 0;  // from rest along one direction: G : d is zero, then rises as it may at most
    const Eigen::Vector3d s0 = straight ? Eigen::Vector3d(0, 0, 0) : Eigen::Vector3d(draw() * 1.5);
    const Eigen::Vector3d s1 = straight     ? Eigen::Vector3d(2.5, 0, 0)
                               : i % 3 == 0 ? Eigen::Vector3d(0.02 * draw())
                                            : Eigen::Vector3d(draw() * 1.5);
    // phi = lambda |G|^2, as G = (s - P s)/(2 lambda).
    double misfit = 0;
    constexpr int parts = 400;
    for (int j = 0; j < parts; ++j) {
      const Eigen::Vector3d s = s0 + (j + 0.5) / parts * (s1 - s0);
      misfit += (viscosity * (rate(s).squaredNorm() - rate(s1).squaredNorm()) - rate(s1).dot(s - s1)) / parts;
    }
    misfit *= 2 * 0.25;  // area and time
    step.before.time = 0.25;
    step.stress(step.before, s0);
    step.stress(step.after, s1);
    FlowBoundMemory memory;
    FlowBoundRecord record(step.model, {}, step.before, memory);
    StepReport report;
    report.step = 1;
    record.add(step.after, report);
    const double square = 2 * 0.25 / 3 * (s1 - s0).squaredNorm() / (4 * viscosity);
    EXPECT_GE(memory.misfit, misfit - 1e-5 * square);
    EXPECT_LE(memory.misfit, square * (1 + 1e-12));
    if (straight) {
      EXPECT_NEAR(memory.misfit, misfit, 1e-5 * square);
    }
    if (rate(s0).isZero(0) && rate(s1).isZero(0)) {
      EXPECT_EQ(memory.misfit, 0);
    }
    sharper = sharper || (misfit > 0.01 * square && memory.misfit < 0.5 * square);
  }
  EXPECT_TRUE(sharper);
}

TEST(FlowBound, tellsWhichConditionFails) {
  OneStep step;
  step.stress(step.after, {3, -2, 1});
  EXPECT_EQ(step.bound().obstacle, "");
  EXPECT_EQ(step.bound({.backwardEuler = false}).obstacle, "steps are not those of backward Euler");
  EXPECT_EQ(step.bound({}, 1).obstacle, "step 2 was cut into parts");
  EXPECT_EQ(step.bound({.chosen = true}, 1).obstacle, "");
  EXPECT_EQ(OneStep(Projection::elasticity).bound().obstacle,
            "the flow of upper has no potential: Perzyna (elasticity)");

  const auto material = perzynaMaterial({1, 0.3}, noteLaw(Projection::frobenius));
  const auto obstacleUnder = [&](const Function& load) {
    Body upper("upper", square(0, 1), material, {{{left, 0, constant(0)}}, {{top, 1, load}}, {}});
    Body lower("lower", square(-1, 1), material,
               {{{left, 0, constant(0)}, {bottom, 1, constant(0)}}, {}, {}});
    return boundedRun(contactModel(std::move(upper), std::move(lower), CouplingKind::mortar, upperBody),
                      {.end = 1, .steps = 8})
        .bound;
  };
  EXPECT_EQ(obstacleUnder(constant(-5)).obstacle, "");  // the run begins with the elastic response
  const FlowBound curved = obstacleUnder([](double, double, double t) { return -5 * t * t; });
  EXPECT_EQ(curved.obstacle, "the traction on label 3 of upper is not linear in time within a step");
}

TEST(FlowBound, knowsWhatContactCosts) {
  OneStep same;
  same.flow();
  const FlowBound fixed = same.bound();
  EXPECT_EQ(fixed.moved, "");
  EXPECT_EQ(fixed.factor, 1);

  OneStep grown;
  grown.flow();
  grown.after.contactForce[0][1] = 6;
  EXPECT_NEAR(grown.bound().factor, std::sqrt(3), 1e-12);
  EXPECT_EQ(grown.bound().strain, fixed.strain);

  OneStep opens;
  opens.flow();
  opens.after.contactForce[0][0] = 0;
  opens.after.gap[0][0] = -0.7;
  EXPECT_EQ(opens.bound().moved, "contact opens while bodies flow");
  // |s - sigma|^2/2 <= A + p G/2
  EXPECT_NEAR(opens.bound().factor, std::sqrt(1 + 2 * 0.7 / 2 / (fixed.stress * fixed.stress / 2)), 1e-12);

  OneStep closes;
  closes.flow();
  closes.before.contactForce[0][0] = 0;
  closes.before.gap[0][0] = -0.7;
  EXPECT_EQ(closes.bound().moved, "contact closes while bodies flow");
  EXPECT_FALSE(std::isfinite(closes.bound().factor));

  OneStep nearer;
  nearer.flow();
  nearer.before.contactForce[0][0] = nearer.after.contactForce[0][0] = 0;
  nearer.before.gap[0][0] = -0.7;
  nearer.after.gap[0][0] = -0.6;
  EXPECT_EQ(nearer.bound().moved, "");
  EXPECT_FALSE(std::isfinite(nearer.bound().factor));
}

TEST(FlowBound, goesOnFromAStateAsIfItHadNotStopped) {
  const Model model = compression(2, 3, perzynaMaterial({50, 0.3}, noteLaw(Projection::frobenius)),
                                  CouplingKind::interpolation, upperBody);
  State state = initialState(model);
  FlowBoundMemory whole;
  FlowBoundMemory parts;
  FlowBoundRecord record(model, {}, state, whole);
  auto other = std::make_unique<FlowBoundRecord>(model, Steps{}, state, parts);
  (void)march(model, state, {.end = 1, .steps = 12}, {}, [&](const State& now, const StepReport& report) {
    record.add(now, report);
    other->add(now, report);
    if (report.step == 5) other = std::make_unique<FlowBoundRecord>(model, Steps{}, now, parts);
  });
  EXPECT_GT(whole.misfit, 0);
  EXPECT_EQ(whole.misfit, parts.misfit);
  EXPECT_EQ(whole.growth, parts.growth);
  EXPECT_EQ(whole.begin, parts.begin);
}

}  // namespace mortier::flow_bound_test
