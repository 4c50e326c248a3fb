// The bound of the error of a run's last state and of its quantities (bound/energy_bound.h).
#pragma once

#include "commands/attempt.h"

namespace mortier {

/// What stops it, an interruption or a lack of memory, is its obstacle: it does not take the result away.
EnergyBound boundOf(const Attempt& attempt);

}  // namespace mortier
