// The bound of the error of a run's last state and of its quantities, and that of what the meshes do to its
// last step (bound/energy_bound.h).
#pragma once

#include "bound/total_bound.h"
#include "commands/attempt.h"

namespace mortier {

/// Whatever goes wrong in them is their obstacle: it does not take the result away.
EnergyBound boundOf(const Attempt& attempt);
EnergyBound stepBoundOf(const Attempt& attempt);
FlowBound flowBoundOf(const FlowBoundRecord& record, const State& state);
TotalBound totalBoundOf(const TotalBoundRecord& record, const State& state, const FlowBound& steps);

}  // namespace mortier
