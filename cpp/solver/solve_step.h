// Solves one time step; the methods that are tried in turn.
#pragma once

#include "solver/step_system.h"

namespace mortier {

/// How much is done before a step is given up.
enum class Effort {
  little,  ///< Newton's method alone: for a step that is likely to be too long
  usual,   ///< for a step that may as well be cut
  all      ///< also what takes thousands of linear solves
};

/// Solves from `guess`, falling back to a start from `state0`; the solution is left in `guess`.
StepOutcome solveStep(StepSystem& system, const State& state0, const StepData& data, Iterate& guess,
                      Effort effort = Effort::usual);

}  // namespace mortier
