#include "time/initial_balance.h"

#include <algorithm>
#include <utility>

#include "base/error.h"
#include "solver/solve_step.h"

namespace mortier {

StepOutcome balanceElastically(const Model& model, State& state, const SolverOptions& options) {
  StepSystem system(model, options);
  Iterate iterate = startingIterate(state);
  StepData data{state.time, 0, {}};
  addThermalStrain(model, state, data);
  StepOutcome outcome = solveStep(system, state, data, iterate);
  if (!outcome.converged()) return outcome;
  state.gap = solvedGaps(model, state, iterate);
  for (size_t b = 0; b < model.bodies.size(); ++b) {
    BodyState& body = state.bodies[b];
    BodyIterate& balanced = iterate.bodies[b];
    body.displacement += balanced.increment.value();
    body.stress = std::move(balanced.stress);
    if (model.bodies[b].heated()) body.thermalStrain = model.bodies[b].thermalStrain(state.time);
  }
  addFrictionWork(model, iterate, state);
  state.contactForce = std::move(iterate.contactForce);
  state.frictionForce = std::move(iterate.frictionForce);
  state.slipping = std::move(iterate.slipping);
  return outcome;
}

double balanceInitialStress(const Model& model, State& state, const SolverOptions& options) {
  const State before = state;
  const StepOutcome outcome = balanceElastically(model, state, options);
  if (outcome.unheld()) throw UnheldBodyError("at t = 0: " + outcome.detail);
  if (!outcome.converged())
    throw InputError("the initial stress cannot be brought into equilibrium at t = 0: " + outcome.detail);
  double change = 0;
  double largest = 0;
  for (size_t b = 0; b < model.bodies.size(); ++b) {
    if (state.bodies[b].stress.size() == 0) continue;
    change = std::max(change, (state.bodies[b].stress - before.bodies[b].stress).cwiseAbs().maxCoeff());
    largest = std::max(largest, state.bodies[b].stress.cwiseAbs().maxCoeff());
  }
  change = model.largest(change);
  largest = model.largest(largest);
  return largest > 0 ? change / largest : 0;
}

}  // namespace mortier
