#include "time/initial_balance.h"

#include <algorithm>

#include "base/error.h"
#include "solver/step.h"

namespace mortier {

double balanceInitialStress(const Model& model, State& state, const SolverOptions& options) {
  StepSolver solver(model, options);
  Iterate iterate = solver.start(state);
  const StepOutcome outcome = solver.solve(state, {state.time, 0, {}}, iterate);
  if (outcome.unheld) throw UnheldBodyError("at t = 0: " + outcome.reason);
  if (!outcome.converged)
    throw InputError("the initial stress cannot be brought into equilibrium at t = 0: " + outcome.reason);
  state.gap = solvedGaps(model, state, iterate);
  double change = 0;
  double largest = 0;
  for (size_t b = 0; b < model.bodies.size(); ++b) {
    BodyState& body = state.bodies[b];
    const BodyIterate& settled = iterate.bodies[b];
    change = std::max(change, (settled.stress - body.stress).cwiseAbs().maxCoeff());
    largest = std::max(largest, settled.stress.cwiseAbs().maxCoeff());
    body.displacement += settled.increment.value();
    body.stress = settled.stress;
  }
  state.contactForce = iterate.contactForce;
  return largest > 0 ? change / largest : 0;
}

}  // namespace mortier
