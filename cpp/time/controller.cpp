#include "time/controller.h"

#include <algorithm>
#include <cmath>
#include <utility>

#include "base/digits.h"
#include "base/error.h"
#include "base/formatted.h"

namespace mortier {
namespace {

constexpr int mostOnsets = 6;       // attempts that may end on the onset of flow
constexpr double aim = 0.7;         // of the tolerance
constexpr double unseenPart = 0.2;  // of the square root of the tolerance

void multiply(StepError& error, double factor) {
  for (Matrix& strain : error.strain) strain *= factor;
  for (Response& response : error.response) {
    response.displacement *= factor;
    response.stress *= factor;
  }
}

}  // namespace

Controller::Controller(const Model& model, const TimePlan& plan, MarchMemory& memory)
    : plan_(plan),
      memory_(memory),
      measure_(model),
      ends_(plan, memory.begin),
      dataTolerance_(unseenPart * std::sqrt(plan.tolerance)),
      hasFriction_(anyFriction(model)) {
  for (const Body& body : model.bodies) flows_ = flows_ || !body.material().linear();
}

double Controller::worst() const {
  return relative(memory_.controller.worst, memory_.controller.largest);
}

std::string Controller::shortfall() const {
  if (worst() <= plan_.tolerance) return "";
  const ControllerMemory& own = memory_.controller;
  return "estimated error " + digits(worst()) + " above tolerance " + digits(plan_.tolerance) + " after " +
         counted(own.trial, "trial") +
         (own.shortestInaccurate ? ": the shortest step that doubles resolve is not accurate enough" : "");
}

void Controller::pilot(StepTaker& taker, State& state) {
  constexpr double steps = 5;
  constexpr double coarse = 0.3;
  const State before = state;
  ErrorNorms largest = measure_.sizeOf(state);
  const double k = (plan_.end - state.time) / steps;
  const auto walk = [&] {
    // Where bodies are passing yield a step twice as long, to where more of them flows, is the easier one.
    bool longer = false;
    for (double t1 = ends_.next(state.time, k, coarse);; t1 = ends_.next(t1, k, coarse)) {
      const Effort effort = longer || t1 == plan_.end ? Effort::usual : Effort::little;
      const StepOutcome outcome = taker.attempt(t1, Scheme::backwardEuler, effort);
      memory_.run.iterations += outcome.iterations;
      memory_.run.factorisations += outcome.factorisations;
      if (outcome.converged()) {
        taker.commit();
        largest = larger(largest, measure_.sizeOf(state));
      }
      if (t1 == plan_.end || (effort == Effort::usual && !outcome.converged())) break;
      longer = !outcome.converged();
    }
  };
  try {
    walk();
  } catch (const DatumError&) {
    // The run ends there as well, and says so.
  }
  state = before;
  memory_.controller.scale = largest;
  memory_.controller.local = aim * plan_.tolerance;
}

void Controller::begin(const State& state) {
  constexpr double firstStep = 1.0 / 24;
  const double whole = plan_.end - state.time;
  RunReport run;
  run.iterations = memory_.run.iterations;
  run.pilotIterations = memory_.run.iterations;
  run.factorisations = memory_.run.factorisations;
  run.solveSeconds = memory_.run.solveSeconds;
  ControllerMemory own;
  own.trial = memory_.controller.trial + 1;
  own.start = state;
  own.timeStep = plan_.steps > 0 ? whole / plan_.steps : firstStep * whole;
  own.scale = memory_.controller.scale;
  own.local = memory_.controller.local;
  own.largest = larger(memory_.controller.largest, measure_.sizeOf(state));
  own.largest.friction = measure_.sizeOf(state).friction;  // of long steps it is too large by far
  const double begin = memory_.begin;
  memory_ = {};
  memory_.begin = begin;
  memory_.run = run;
  memory_.controller = own;
  second_.reset();
}

bool Controller::abandons() {
  ControllerMemory& own = memory_.controller;
  const int iterations = memory_.run.iterations - memory_.run.pilotIterations;
  const bool exceeds = relative(own.worst, own.scale) > plan_.tolerance;  // the scale may have grown
  own.crossing = exceeds ? (own.crossing > 0 ? own.crossing : iterations) : 0;
  return own.crossing > 0 && iterations >= 2 * own.crossing && own.trial < trials && !own.shortestInaccurate;
}

bool Controller::beginAgain(State& state) {
  constexpr double least = 1e-4;  // by which the error of a step changes at once
  ControllerMemory& own = memory_.controller;
  const bool ended = state.time == plan_.end;
  const double foreseen = std::exchange(own.scale, ended ? own.largest : own.scale).friction;
  const double error = relative(own.worst, own.scale);
  if (error <= plan_.tolerance || own.shortestInaccurate || own.trial >= trials) return false;
  // Where friction is what counts, errors were too small for their scale, and by as much fewer steps will do.
  if (own.worst.friction > 0 && relative({0, 0, own.worst.friction}, own.scale) >= error)
    own.local = std::min(own.local * foreseen / own.scale.friction, aim * plan_.tolerance);
  const double order = plan_.scheme == Scheme::backwardEuler || hasFriction_ ? 1 : 2;
  // Many small steps are the easier to foresee; of a run that did not end the error may still grow.
  const double next = ended ? (order == 1 ? 0.8 : aim) : (order == 1 ? 0.6 : 0.4);
  own.local *= std::max(least, std::pow(next * plan_.tolerance / error, (order + 1) / order));
  // So many steps cannot be wrong by more in all.
  own.local = std::max(own.local, aim * plan_.tolerance / plan_.maxSteps);
  state = own.start;
  begin(State(state));
  return true;
}

/// Adds the error of the step to what has been carried to its end. Flow does not amplify errors: where the
/// linearised step does, points that flow and points that do not lie side by side, and the error is taken on
/// as it was. A contact that closes does amplify them: errors of displacements become errors of stresses.
void Controller::add(StepTaker& taker, StepError local, double size, SlipAndWork missed) {
  ControllerMemory& own = memory_.controller;
  const std::vector<Matrix> before = std::exchange(own.strain, std::move(local.strain));
  std::vector<Response>& response = local.response;
  StepError carried;
  if (!before.empty()) {
    carried = taker.carried(before, own.slip.slip);
    addTo(response, carried.response);
  }
  for (size_t b = 0; b < before.size(); ++b) own.strain[b] += carried.strain[b];
  if (!missed.slip.empty()) size += sizeOf(taker, missed);
  const std::vector<Matrix> flowed = std::exchange(missed.strain, {});
  if (!missed.slip.empty()) addTo(response, taker.response(flowed, missed.slip));
  // Where rows are others in every step, what pairs miss has no sign of its own: it depends on where in the
  // passage of a node each of them begins.
  if (taker.follows()) missed.work = std::abs(missed.work);
  addTo(own.slip, 1, missed);
  addTo(own.strain, 1, flowed);
  if (hasFriction_) carrySlip(taker, taker.slipOf(response));
  ErrorNorms error = measure_.sizeOf(response);
  error.friction = std::abs(own.slip.work);
  const double bound = relative(own.error, own.scale) + size;
  if (taker.closes()) {
    own.error = error;
    own.worst = larger(own.worst, own.error);
    return;
  }
  if (!before.empty() && !(relative(error, own.scale) <= bound))
    for (size_t b = 0; b < before.size(); ++b) own.strain[b] += before[b] - carried.strain[b];
  own.error = {std::min(std::max(error.stress, size * own.scale.stress), bound * own.scale.stress),
               std::min(error.displacement, bound * own.scale.displacement), error.friction};
  own.worst = larger(own.worst, own.error);
}

Controller::Judgement Controller::judge(StepTaker& taker, double t0, double t1) const {
  Judgement result{taker.localError()};
  ErrorNorms norms = measure_.sizeOf(result.local.response);
  // Stages miss what the flow, and so the stress, changes by between them.
  double change = 0;
  for (size_t i = 0; i < taker.stages(); ++i)
    change = std::max(change, measure_.sizeOf(taker.change(i)).stress);
  const ErrorNorms& scale = memory_.controller.scale;
  const bool ofStress = relative({norms.stress, 0, 0}, scale) > relative({0, norms.displacement, 0}, scale);
  if (norms.stress > change && ofStress) multiply(result.local, change / norms.stress);
  norms.stress = std::min(norms.stress, change);
  const ControllerMemory& own = memory_.controller;
  result.size = relative(norms, own.scale);
  result.change = relative({change, 0, 0}, own.scale);
  const double error = result.size / own.local;
  result.factor = std::clamp(safety * std::pow(error, -1.0 / taker.errorOrder()), leastFactor, largestFactor);
  result.good = error <= 1 || isShortest(t0, t1 - t0);
  return result;
}

bool Controller::isShortest(double t, double k) const {
  constexpr double rounding = 1.5;  // of times: the shortest step may come out a little longer
  return k <= rounding * leastStep(t);
}

/// What time resolves at t. Relaxation may begin at once, and take no more of the run than that.
double Controller::leastStep(double t) const {
  constexpr double little = 1e-13;
  return little * std::max(std::abs(t), little * (plan_.end - memory_.begin));
}

/// Whether the first points to flow turn by more than a step may miss.
/// Where most flow the turn is behind them.
bool Controller::turnsTooFar(const StepTaker& taker) const {
  constexpr double most = 0.5;
  const double flowing = taker.flowingAtEnd();
  if (flowing == 0 || flowing > most) return false;
  const ControllerMemory& own = memory_.controller;
  return measure_.sizeOf(taker.turn()).stress > own.local * own.scale.stress;
}

StepOutcome Controller::attempt(StepTaker& taker, double t0, double t1, int onsets, Judgement& judgement) {
  constexpr double early = 0.05;  // parts of a step: it ends on the onset of flow between them
  constexpr double late = 0.95;
  constexpr double shorter = 0.8;
  StepOutcome outcome = taker.attempt(t1);
  if (!outcome.converged() || outcome.method == SolutionMethod::rest) return outcome;
  judgement = judge(taker, t0, t1);
  const bool turned = onsets > 0 && turnsTooFar(taker);
  if (turned || (onsets == mostOnsets && !judgement.good)) {
    const double onset = taker.onset();
    // Later than that it is where the load bends, and not well known.
    if (onset > early && (onset < late || turned)) {
      judgement.factor = onset < late ? onset : shorter;
      judgement.good = false;
      return outcome;
    }
  }
  // What is too long without the guard is too long with it, whose steps are of the first order; but where the
  // data turn to rest they are exact.
  const bool turns = t0 == memory_.begin || ends_.isBreak(t0);
  constexpr double rounding = 1e-4;  // of what a step may be wrong by: many steps of that are nothing too
  const bool changes = judgement.change > rounding * memory_.controller.local;
  if (!changes || (!judgement.good && !turns) || !taker.flowReversed()) return outcome;
  outcome = taker.guard(outcome);
  if (outcome.converged()) judgement = judge(taker, t0, t1);
  return outcome;
}

/// Whether methods fail all the time, and neither steps as those so far nor steps as short as the last
/// attempt would reach the end. One hard moment in a run that gets on is not meant.
bool Controller::stepsTooSmall(double t, double k) const {
  constexpr int many = 100;
  constexpr int often = 4;  // one step in so many
  const auto cut = memory_.run.rungs.find(nameOf(SolutionMethod::cut));
  if (cut == memory_.run.rungs.end() || cut->second < many || often * cut->second < memory_.run.steps)
    return false;
  const double pace = (t - memory_.begin) / memory_.run.steps;
  return plan_.end - t > std::max(k, pace) * plan_.maxSteps;
}

void Controller::advance(StepTaker& taker, const State& state, StepReport& report) {
  constexpr int patience = 14;  // attempts in a row that cannot be solved
  int failures = 0;
  ControllerMemory& own = memory_.controller;
  const bool elastic = taker.flowing() == 0;
  const auto giveUp = [&](Status status, double t1, const std::string& why) {
    report.status = status;
    report.reason = formatted("step %d at t = %g: ", report.step, t1) + why;
  };
  while (true) {
    const bool second = inPair(state.time);
    const double end = second ? own.pairEnd : ends_.next(state.time, own.timeStep, dataTolerance_);
    const double k = end - state.time;
    if (memory_.run.steps + memory_.run.rejected + report.rejections >= plan_.maxSteps)
      return giveUp(Status::failed, end,
                    "all of max_steps = " + std::to_string(plan_.maxSteps) + " are used");
    Attempt step = attemptOfPair(taker, state.time, end, elastic ? mostOnsets - report.rejections : 0);
    const StepOutcome& outcome = step.outcome;
    const Judgement& judgement = step.judgement;
    const double t1 = step.t1;
    report.iterations += outcome.iterations;
    report.factorisations += outcome.factorisations;
    if (!outcome.converged()) {
      report.method = SolutionMethod::cut;
      ++report.rejections;
      // The end of equilibrium is approached as closely as the tolerance asks.
      if (outcome.unheld() && k <= plan_.tolerance * (plan_.end - memory_.begin))
        return giveUp(Status::unheld, t1, outcome.detail + taker.nearFacingLimit());
      if (stepsTooSmall(state.time, k))
        return giveUp(Status::failed, t1,
                      "at the pace of the steps that can be solved max_steps = " +
                          std::to_string(plan_.maxSteps) + " would not reach the end: " + outcome.detail);
      if (++failures == patience)
        return giveUp(outcome.unheld() ? Status::unheld : Status::failed, t1, outcome.detail);
      own.timeStep = failureFactor * k;
      own.pairEnd = 0;
      continue;
    }
    failures = 0;
    // No trial makes the shortest steps more accurate.
    if (judgement.good && judgement.size > plan_.tolerance) own.shortestInaccurate = true;
    double factor = judgement.factor;
    const auto reject = [&] {
      ++report.rejections;
      own.timeStep = std::max(leastStep(state.time), k * factor);
    };
    if (!judgement.good) {
      reject();
      continue;
    }
    std::optional<StepTaker::Kept> kept;
    // What passes within a step that begins where the data turn its stages do not have either.
    const bool begins = state.time == memory_.begin || ends_.isBreak(state.time);
    const bool closes = outcome.method != SolutionMethod::rest && taker.closes();
    const bool looksOn =
        (closes || taker.guarded() || (begins && !hasFriction_ && outcome.method != SolutionMethod::rest)) &&
        flows_ && !isShortest(state.time, k);
    if (step.beginsPair || looksOn) kept = taker.kept();
    const double twice = std::exp2(tableau(plan_.scheme).stages.size());  // the error of a step twice as long
    if (looksOn) multiply(step.judgement.local, 1 / twice);
    if (outcome.method != SolutionMethod::rest)
      add(taker, std::move(step.judgement.local), judgement.size,
          second ? std::exchange(own.missed, {}) : SlipAndWork());
    taker.commit();
    if (step.beginsPair && !completePair(taker, step, end, report, factor)) {
      taker.goBack(std::move(*kept));
      reject();
      continue;
    }
    if (step.beginsPair) taker.showState();
    if (looksOn && !repeatInHalves(taker, std::move(*kept), state, closes ? k : 0, report, factor)) {
      reject();
      continue;
    }
    // A step that was only shortened to end on a stop is no reason against a longer one.
    const bool shortened = k < own.timeStep && factor >= 1;
    const double grown = (report.rejections > 0 ? std::min(factor, 1.0) : factor) * k;
    if (!second) own.timeStep = std::max(leastStep(t1), shortened ? std::max(grown, own.timeStep) : grown);
    const ErrorNorms reached = measure_.sizeOf(state);
    own.scale = larger(own.scale, reached);
    own.largest = larger(own.largest, reached);
    report.time = t1;
    report.timeStep = k;
    report.estimate = relative(own.error, own.scale);
    report.guarded = taker.guarded();
    report.certificate = outcome.certificate;
    if (outcome.method != SolutionMethod::newton && report.method == SolutionMethod::newton)
      report.method = outcome.method;
    return;
  }
}

}  // namespace mortier
