#include "time/initial_balance.h"

#include <algorithm>

#include "base/error.h"

namespace mortier {

bool actsAtOnce(const Model& model, const State& state) {
  constexpr double rounding = 1e-13;  // of coordinates: what meshes leave of a distance
  bool acts = false;
  for (size_t b = 0; b < model.bodies.size(); ++b) {
    const Body& body = model.bodies[b];
    Vector prescribed = Vector::Zero(body.dofs());
    body.prescribe(state.time, prescribed);
    const bool isAtRest = state.bodies[b].displacement.isZero(0) && state.bodies[b].stress.isZero(0);
    acts = acts || !isAtRest || body.hasInitialStress() || !prescribed.isZero(0) ||
           !body.load(state.time).isZero(0) || (body.heated() && !body.thermalStrain(state.time).isZero(0));
  }
  for (size_t k = 0; k < model.interfaces.size(); ++k) {
    double largest = 0;
    for (const int b : {model.interfaces[k].pair().nonmortar.body, model.interfaces[k].pair().mortar.body})
      largest = std::max(largest, model.bodies[b].largestCoordinate());
    // An overlap as drawn that may be none: what is not known of curved surfaces.
    const double unknown = model.interfaces[k].dimension() == 3 ? model.interfaces[k].sagitta() : 0;
    acts = acts || (state.gap[k].array() > std::max(unknown, rounding * largest)).any();
  }
  return acts;
}

double balanceInitialStress(const Model& model, State& state, const SolverOptions& options) {
  const State before = state;
  MarchMemory memory;
  const StepOutcome outcome =
      StepTaker(model, state, memory, Scheme::backwardEuler, options, false, false).jump();
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
  return largest > 0 ? change / largest : 0;
}

}  // namespace mortier
