// The march in time: state in, state out, one report a step.
#pragma once

#include <functional>
#include <string>

#include "solver/model.h"
#include "solver/state.h"
#include "time/scheme.h"

namespace mortier {

struct TimePlan {
  double end = 1;  ///< T [s]
  int steps = 1;   ///< N equal steps
  Scheme scheme = Scheme::backwardEuler;
};

struct RunReport {
  Status status = Status::converged;
  std::string reason;  ///< one line when the status is not converged
  int steps = 0;       ///< completed
  int iterations = 0;
  int maxIterationsInAStep = 0;
  int factorisations = 0;
  double solveSeconds = 0;  ///< wall time of the march without its observer
  Certificate worst;        ///< the largest residuals of any step
};

/// Called for the initial state (report.step == 0) and after every converged step.
using Observer = std::function<void(const State& state, const StepReport& report)>;

/// u0 = 0 but for what is prescribed at t = 0, sigma0 = 0.
State initialState(const Model& model);

/// Marches `state` to the end of the plan; on failure it is left at the last converged step.
/// \throws UnheldBodyError when nothing holds a body.
RunReport march(const Model& model, State& state, const TimePlan& plan, const SolverOptions& options,
                const Observer& observer);

}  // namespace mortier
