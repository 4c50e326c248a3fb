// The march in time: state in, state out, one report a step.
#pragma once

#include <functional>

#include "solver/model.h"
#include "solver/state.h"
#include "time/memory.h"
#include "time/plan.h"
#include "time/report.h"

namespace mortier {

class StepTaker;

/// Called for the initial state (report.step == 0) and after every converged step. With steps chosen by their
/// error it may be called for the initial state again: what came before is void, as its error in time was too
/// large.
using Observer = std::function<void(const State& state, const StepReport& report)>;

/// Called at the end of a run that is complete, with the factors of its last step.
using AtEnd = std::function<void(StepTaker& taker)>;

/// Before anything acts: u0 = 0, sigma0 the initial stress of the bodies. march() lets the data of t = 0 act.
State initialState(const Model& model);

/// Marches `state` to the end of the plan; on failure it is left at the last converged step.
/// \throws UnheldBodyError when nothing holds a body.
RunReport march(const Model& model, State& state, const TimePlan& plan, const SolverOptions& options,
                const Observer& observer);

/// The same from a `memory` that the caller keeps. Whenever the observer is called, `state` and `memory` are
/// what a later call needs to go on from there (the plan unchanged): it does not repeat the initial state.
RunReport march(const Model& model, State& state, MarchMemory& memory, const TimePlan& plan,
                const SolverOptions& options, const Observer& observer, const AtEnd& atEnd = {});

}  // namespace mortier
