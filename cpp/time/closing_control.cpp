// Steps chosen by their error in which contact closes (controller.h).
#include <algorithm>
#include <utility>

#include "time/controller.h"

namespace mortier {

/// Error of the step of length k that ended at t, relative, as the step after shows it. Where contact closes
/// shortly before the end of a step, the stress that follows at once has hardly begun there, and neither the
/// step nor its stages show by how much more it grows.
double Controller::closingTimeError(StepTaker& taker, double t, double k, StepReport& report) const {
  if (ends_.isBreak(t)) return 0;  // what comes after is another load
  const double end = std::min(t + k, ends_.breakAfter(t));
  const StepOutcome outcome = taker.attempt(end, Effort::little);
  report.iterations += outcome.iterations;
  report.factorisations += outcome.factorisations;
  if (!outcome.converged() || outcome.method == SolutionMethod::rest) return 0;
  return relative(measure_.sizeOf(taker.lagAtStart()), memory_.controller.scale);
}

bool Controller::repeatInHalves(StepTaker& taker, StepTaker::Kept start, const State& state, double closing,
                                StepReport& report, double& factor) {
  ControllerMemory& own = memory_.controller;
  second_.reset();
  double off = halve(taker, start, state, report);
  if (off <= own.local && closing > 0) off += closingTimeError(taker, state.time, closing, report);
  if (off > own.local) {
    taker.goBack(std::move(start));
    own.pairEnd = 0;
    own.missed = {};
    factor = std::clamp(safety * own.local / off, leastFactor, safety);
    return false;
  }
  own.worst = larger(own.worst, {own.error.stress + off * own.scale.stress, 0, 0});
  return true;
}

/// Repeats the step that ended in the state as two half steps, and keeps these. \returns by how much they end
/// elsewhere, relative; nothing where they cannot be solved
double Controller::halve(StepTaker& taker, const StepTaker::Kept& start, const State& state,
                         StepReport& report) {
  StepTaker::Kept end = taker.kept();
  const State& reached = end.first;
  taker.goBack(start);
  if (!end.second.increments.empty()) {  // half of them is a better guess than the step before
    memory_.increments = end.second.increments;
    memory_.timeStep = end.second.timeStep;
  }
  for (const double t1 : {start.first.time + (reached.time - start.first.time) / 2, reached.time}) {
    StepOutcome outcome = taker.attempt(t1);
    if (outcome.converged() && taker.flowReversed()) outcome = taker.guard(outcome);
    report.iterations += outcome.iterations;
    report.factorisations += outcome.factorisations;
    if (!outcome.converged()) {
      taker.goBack(std::move(end));
      return 0;
    }
    taker.commit();
  }
  std::vector<Response> off;
  for (size_t b = 0; b < state.bodies.size(); ++b)
    off.push_back({state.bodies[b].displacement - reached.bodies[b].displacement,
                   state.bodies[b].stress - reached.bodies[b].stress});
  memory_.controller = std::move(end.second.controller);
  return relative(measure_.sizeOf(off), memory_.controller.scale);
}

}  // namespace mortier
