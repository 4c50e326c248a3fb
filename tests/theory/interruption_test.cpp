// Whoever asks for it stops every loop that may last.
#include <gtest/gtest.h>

#include <cmath>

#include "base/interrupt.h"
#include "linear/condensing_solver.h"
#include "theory/scenes.h"
#include "unit/enumerated_contact.h"

namespace mortier::interruption_test {

using namespace scenes;

class Interruption : public testing::Test {
 protected:
  void TearDown() override { interruption::requested = false; }
  Model model_ = compression(4, 6, perzynaMaterial(noteElasticity, noteLaw(Projection::frobenius)),
                             CouplingKind::mortar, upperBody);
};

TEST_F(Interruption, stopsTheContactProblem) {
  Randoms random(1);
  const ContactProblem problem{symmetricPositive(random, 5), true, Matrix(5, 0)};
  requestInterrupt();
  EXPECT_THROW(solveContact(problem, random.vector(5), Vector::Zero(5), Vector(0), random.set(5)),
               Interrupted);
}

TEST_F(Interruption, stopsAFactorisation) {
  const Body& body = model_.bodies[0];
  for (const auto& make : {multifrontalSolver, suiteSparseSolver}) {
    const auto solver = make(body.pattern(), {0, 1, 2});
    interruption::requested = true;
    EXPECT_THROW(solver->factorise(std::vector<double>(body.pattern().entries(), 0)), Interrupted);
    interruption::requested = false;
  }
}

TEST_F(Interruption, aTimeLimitStopsWhatTakesLongerAndNothingAfterIt) {
  State state = initialState(model_);
  const TimePlan plan{.end = 1, .steps = 2};
  const auto none = [](const State&, const StepReport&) {};
  {
    const TimeLimit over(0);
    EXPECT_THROW(march(model_, state, plan, {}, none), TimeIsUp);
  }
  for (const double seconds : {1e3, double(INFINITY)}) {
    const TimeLimit limit(seconds);
    state = initialState(model_);
    EXPECT_EQ(march(model_, state, plan, {}, none).status, Status::converged);
  }
  state = initialState(model_);
  EXPECT_EQ(march(model_, state, plan, {}, none).status, Status::converged);
}

// Between two steps, in the middle of one with every method, and while the scales of the error are found.
TEST_F(Interruption, stopsAMarch) {
  for (const Method method : {Method::newton, Method::penaltyDuality})
    for (const bool controlled : {false, true}) {
      if (controlled && method == Method::penaltyDuality) continue;
      TimePlan plan;
      plan.end = 1;
      plan.steps = 10;
      if (controlled) plan.tolerance = 1e-3;
      SolverOptions options;
      options.method = method;
      State state = initialState(model_);
      interruption::requested = true;
      EXPECT_THROW(march(model_, state, plan, options, [](const State&, const StepReport&) {}), Interrupted);
      interruption::requested = false;
      state = initialState(model_);
      int steps = 0;
      EXPECT_THROW(march(model_, state, plan, options,
                         [&](const State&, const StepReport& report) {
                           steps = report.step;
                           if (report.step == 2) requestInterrupt();
                         }),
                   Interrupted);
      EXPECT_EQ(steps, 2);
      interruption::requested = false;
    }
}

}  // namespace mortier::interruption_test
