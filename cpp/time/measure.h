// What is reported of a state.
#pragma once

#include "solver/model.h"
#include "solver/state.h"
#include "solver/step.h"

namespace mortier {

/// Fills penetration, pressure, contact force and viscoplastic share of `report`.
void measure(const Model& model, const State& state, StepReport& report);

/// Fills what became of the active sets in a step.
void compareActive(const ActiveSets& before, const ActiveSets& after, StepReport& report);

/// The larger of each residual.
Certificate worse(const Certificate& a, const Certificate& b);

}  // namespace mortier
