// The jump at t = 0. Before it the bodies are undeformed, as drawn, with their initial stress s0; at t = 0
// loads, supports, distances and temperatures act at once and the bodies respond elastically,
//   E^-1 (s - s0) = B u - thermal strain,   sum |T| B' s + C'p = F,   g <= 0, p >= 0, p g = 0,
// friction included: a step of length zero (step_taker.h). It changes nothing where all that is in
// equilibrium with s0 already.
#pragma once

#include "solver/model.h"
#include "solver/state.h"
#include "time/step_taker.h"

namespace mortier {

/// Whether any load, support, temperature, overlap or initial stress acts at the state's time.
bool actsAtOnce(const Model& model, const State& state);

/// Lets the bodies jump from a state without loads. \returns by how much their stress changed, over the
/// largest stress.
/// \throws InputError when there is no such state, UnheldBodyError where contact cannot hold a body.
double balanceInitialStress(const Model& model, State& state, const SolverOptions& options);

}  // namespace mortier
