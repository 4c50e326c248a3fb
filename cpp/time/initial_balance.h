// Equilibrium and contact at t = 0.
#pragma once

#include "solver/model.h"
#include "solver/outcome.h"
#include "solver/state.h"

namespace mortier {

/// Lets the bodies deform elastically: with the loads and supports of the state's time,
///   E^-1 (s - s0) = B u,   sum |T| B' s + C'p = F,   g <= 0, p >= 0, p g = 0,
/// which changes nothing where s0 is in equilibrium already. Where that is impossible the state is left
/// alone.
StepOutcome balanceElastically(const Model& model, State& state, const SolverOptions& options);

/// The same for an initial stress. \returns by how much the stress changed, over the largest stress.
/// \throws InputError when there is no such state, UnheldBodyError where contact cannot hold a body.
double balanceInitialStress(const Model& model, State& state, const SolverOptions& options);

}  // namespace mortier
