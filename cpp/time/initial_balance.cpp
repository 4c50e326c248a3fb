#include "time/initial_balance.h"

#include <algorithm>
#include <utility>

#include "base/error.h"

namespace mortier {

StepOutcome settle(const Model& model, State& state, const SolverOptions& options) {
  StepSolver solver(model, options);
  Iterate iterate = solver.start(state);
  StepOutcome outcome = solver.solve(state, {state.time, 0, {}}, iterate);
  if (!outcome.converged) return outcome;
  state.gap = solvedGaps(model, state, iterate);
  for (size_t b = 0; b < model.bodies.size(); ++b) {
    BodyState& body = state.bodies[b];
    BodyIterate& settled = iterate.bodies[b];
    body.displacement += settled.increment.value();
    body.stress = std::move(settled.stress);
  }
  state.contactForce = std::move(iterate.contactForce);
  return outcome;
}

double balanceInitialStress(const Model& model, State& state, const SolverOptions& options) {
  const State before = state;
  const StepOutcome outcome = settle(model, state, options);
  if (outcome.unheld) throw UnheldBodyError("at t = 0: " + outcome.reason);
  if (!outcome.converged)
    throw InputError("the initial stress cannot be brought into equilibrium at t = 0: " + outcome.reason);
  double change = 0;
  double largest = 0;
  for (size_t b = 0; b < model.bodies.size(); ++b) {
    change = std::max(change, (state.bodies[b].stress - before.bodies[b].stress).cwiseAbs().maxCoeff());
    largest = std::max(largest, state.bodies[b].stress.cwiseAbs().maxCoeff());
  }
  return largest > 0 ? change / largest : 0;
}

}  // namespace mortier
