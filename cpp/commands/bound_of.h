// The bound of the error of a run's last state and of its quantities (bound/energy_bound.h), and that of what
// the meshes do to its last step (bound/step_bound.h).
#pragma once

#include "commands/attempt.h"

namespace mortier {

/// What stops them, an interruption or a lack of memory, is their obstacle: it does not take the result away.
EnergyBound boundOf(const Attempt& attempt);
StepBound stepBoundOf(const Attempt& attempt);

}  // namespace mortier
