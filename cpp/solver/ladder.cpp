#include <algorithm>
#include <utility>

#include "solver/step.h"
#include "solver/viscosity_path.h"

namespace mortier {

// What is tried in turn. The methods that take thousands of linear solves come last, and are for projections that are
// not associated: with a symmetric tangent the interior point method leads to the one solution.
StepOutcome StepSolver::solve(const State& state0, const StepData& step, Iterate& guess, Effort effort) {
  if (options_.reduce && step.settled) {
    Iterate resting;
    if (StepOutcome outcome = rest(state0, step, resting); outcome.converged) {
      guess = std::move(resting);
      return outcome;
    }
  }
  if (options_.method == Method::penaltyDuality) return penaltyDuality(state0, step, guess);
  constexpr int plainIterations = 7;
  constexpr int continuationIterations = 60;
  constexpr int usualIterations = 300;
  constexpr int pathIterations = 1500;
  NewtonLimits plain{std::min(plainIterations, options_.maxIterations), options_.tolerance};
  plain.turning = true;
  StepOutcome total = newton(state0, step, plain, guess);
  const auto climb = [&](const std::string& rung, StepOutcome next) {
    next.rung = rung;
    next.iterations += total.iterations;
    next.factorisations += total.factorisations;
    total = std::move(next);
  };
  const auto left = [&](int most) { return std::min(most, options_.maxIterations) - total.iterations; };
  const auto open = [&](int most) { return !total.converged && !total.unheld && left(most) > 0; };
  // What flowed may unload.
  if (open(usualIterations) && flows(state0)) {
    plain.iterations = std::min(plainIterations, left(options_.maxIterations));
    plain.turning = false;
    plain.elasticFirst = true;
    Iterate unloaded = start(state0);
    climb("newton", newton(state0, step, plain, unloaded));
    if (total.converged) guess = std::move(unloaded);
  }
  if (effort == Effort::little) return total;
  if (open(usualIterations) && !uniqueSolutions_)
    climb("continuation",
          continuation(state0, step, std::min(continuationIterations, left(usualIterations)), guess));
  if (open(usualIterations))
    climb("interior-point", interiorPoint(state0, step, left(usualIterations), guess));
  if (open(usualIterations)) climb("continuation", continuation(state0, step, left(usualIterations), guess));
  if (effort == Effort::usual || uniqueSolutions_) return total;
  if (open(options_.maxIterations))
    climb("path", ViscosityPath(*this, state0, step)
                      .follow(std::min(pathIterations, left(options_.maxIterations)), guess));
  if (open(options_.maxIterations))
    climb("damping", damped(state0, step, left(options_.maxIterations), guess));
  return total;
}

}  // namespace mortier
