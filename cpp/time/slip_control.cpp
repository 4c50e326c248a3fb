// Steps chosen by their error where there is friction: pairs of steps (controller.h).
#include <algorithm>
#include <cmath>
#include <utility>

#include "time/controller.h"

namespace mortier {

/// What nodes that stick have missed of their slip they keep; of those that slip the friction is known, and
/// where they are follows from the others (solver/respond.cpp).
double Controller::sizeOf(StepTaker& taker, const SlipAndWork& missed) const {
  ErrorNorms norms = measure_.sizeOf(taker.response(missed.strain, missed.slip));
  norms.friction = std::abs(missed.work);
  return relative(norms, memory_.controller.scale);
}

/// Adds a step of a pair to what one of twice the length misses of it: of the flow what its stages do not
/// show. What they do show that one misses 2^(p+1) times. A node that closes in the pair and sticks slips, in
/// the solution, in the first step of the pair or not at all: the slip before closing is added.
void Controller::addOfPair(const StepTaker& taker, const Judgement& of, SlipAndWork& missed) {
  addTo(missed, 1, taker.slip());
  addTo(missed, 2, {taker.slipBeforeClosing(), 0, {}});
  addTo(missed.strain, 1 - std::exp2(taker.errorOrder() - 1), of.local.strain);
}

/// Nodes that slip have no error of their own: they follow the others. What they make up for as they begin to
/// slip, and as the others carry them on, dissipates; not where rows are others in every step.
void Controller::carrySlip(const StepTaker& taker, std::vector<Vector> slip) {
  SlipAndWork& own = memory_.controller.slip;
  if (!taker.follows()) own.work += taker.workAlong(slip) - taker.workAlong(own.slip);
  own.slip = std::move(slip);
}

Controller::Attempt Controller::attemptOfPair(StepTaker& taker, double t0, double end, int onsets) {
  Attempt step{end};
  if (inPair(t0)) {
    if (second_ && second_->t1 == end) return *std::exchange(second_, std::nullopt);
    step.outcome = attempt(taker, t0, end, 0, step.judgement);
    step.judgement.good = true;  // as it was when the pair was begun
    return step;
  }
  if (hasFriction_ && !isShortest(t0, end - t0)) {  // no time lies within a jump
    step.outcome = taker.attempt(end);
    if (!step.outcome.converged() || step.outcome.method == SolutionMethod::rest) return step;
    addTo(step.missed, -1, taker.slip());
    addTo(step.missed, -1, {taker.slipBeforeClosing(), 0, {}});
    step.t1 = t0 + (end - t0) / 2;
    step.beginsPair = true;
  }
  const StepOutcome once = step.outcome;
  step.outcome = attempt(taker, t0, step.t1, onsets, step.judgement);
  step.outcome.iterations += once.iterations;
  step.outcome.factorisations += once.factorisations;
  if (step.beginsPair && step.outcome.converged()) {
    addOfPair(taker, step.judgement, step.missed);
    step.contactChanges = taker.contactChanges();
  }
  return step;
}

bool Controller::completePair(StepTaker& taker, const Attempt& first, double end, StepReport& report,
                              double& factor) {
  constexpr double largest = 2;  // nodes change one by one: that none did in a pair says little of the next
  ControllerMemory& own = memory_.controller;
  Attempt second{end};
  second.outcome = attempt(taker, first.t1, end, 0, second.judgement);
  bool good = second.outcome.converged() && second.judgement.good;
  if (good) {
    SlipAndWork missed = first.missed;
    addOfPair(taker, second.judgement, missed);
    // Stages show the flow unless contact changes between them.
    if (!first.contactChanges && !taker.contactChanges()) missed.strain.clear();
    const double size = sizeOf(taker, missed);
    const double fits = safety * std::pow(size / own.local, -0.5);  // a pair misses k^2
    factor = std::min({factor, second.judgement.factor, std::clamp(fits, leastFactor, largest)});
    good = size <= own.local || isShortest(first.t1, end - first.t1);
    if (good && size > plan_.tolerance) own.shortestInaccurate = true;
    own.missed = std::move(missed);
  } else {
    factor = second.outcome.converged() ? second.judgement.factor : failureFactor;
  }
  if (good) {
    own.pairEnd = end;
    second_ = std::move(second);
  } else {
    report.iterations += second.outcome.iterations;
    report.factorisations += second.outcome.factorisations;
  }
  return good;
}

}  // namespace mortier
