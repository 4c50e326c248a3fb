#include "time/march.h"

#include <algorithm>
#include <chrono>
#include <cmath>
#include <optional>
#include <utility>

#include "base/digits.h"
#include "base/error.h"
#include "base/formatted.h"
#include "time/controller.h"
#include "time/initial_balance.h"
#include "time/measure.h"
#include "time/step_taker.h"

namespace mortier {
namespace {

/// Goes to time t1 in one step, or in as many smaller ones as it takes; the state is left at the last that
/// converged.
void advance(StepTaker& taker, const State& state, double t1, StepReport& report) {
  constexpr int smallest = 256;  // smallest part of a step that is tried
  const double begin = state.time;
  int parts = 1;
  int done = 0;
  while (done < parts) {
    const double time = done + 1 == parts ? t1 : begin + (t1 - begin) * (done + 1) / parts;
    const Effort effort = parts == 1 ? Effort::all : Effort::usual;
    StepOutcome outcome = taker.attempt(time, effort);
    if (outcome.converged() && taker.flowReversed()) outcome = taker.guard(outcome, effort);
    report.iterations += outcome.iterations;
    report.factorisations += outcome.factorisations;
    if (outcome.method != SolutionMethod::newton && report.method == SolutionMethod::newton)
      report.method = outcome.method;
    if (outcome.converged()) {
      report.certificate = worse(report.certificate, outcome.certificate);
      report.guarded = report.guarded || taker.guarded();
      taker.commit();
      ++done;
      continue;
    }
    // A body may be unheld where contact would be after too large a step only. Shorter steps press less: they
    // miss the contact that an overlap is without even more.
    if ((outcome.unheld() && !taker.follows()) || outcome.reason == Reason::overlap || parts == smallest) {
      report.status = outcome.unheld() ? Status::unheld : Status::failed;
      report.reason = formatted("step %d at t = %g: ", report.step, time) + outcome.detail;
      if (outcome.unheld()) report.reason += taker.nearFacingLimit();
      return;
    }
    parts *= 2;
    done *= 2;
    ++report.rejections;
    report.method = SolutionMethod::cut;
  }
}

/// Adds a step to the sums of the run.
void add(const StepReport& report, RunReport& run) {
  run.iterations += report.iterations;
  run.factorisations += report.factorisations;
  run.maxIterationsInAStep = std::max(run.maxIterationsInAStep, report.iterations);
  run.rejected += report.rejections;
  run.status = report.status;
  run.reason = report.reason;
  if (report.status != Status::converged) return;
  run.steps = report.step;
  ++run.rungs[nameOf(report.method)];
  run.guarded += report.guarded ? 1 : 0;
  run.worst = worse(run.worst, report.certificate);
}

using Clock = std::chrono::steady_clock;

double secondsSince(Clock::time_point begin) {
  return std::chrono::duration<double>(Clock::now() - begin).count();
}

/// Strains and rotations of bodies that contact follows.
void raiseDeformation(const Model& model, const State& state, Peaks& peaks) {
  for (const ContactInterface& interface : model.interfaces)
    for (const int b : {interface.pair().nonmortar.body, interface.pair().mortar.body}) {
      if (!interface.follows() || model.bodies[b].rigid()) continue;
      const Deformation most = deformationOf(model.bodies[b], state.bodies[b].displacement);
      peaks.strain.raise(most.strain, state.time);
      peaks.rotation.raise(most.rotation, state.time);
    }
}

/// A possible cause of a failed step: strains and rotations beyond the limits of linear kinematics, as of a
/// block that tips. Empty where all are small.
std::string beyondSmall(const Peaks& peaks) {
  std::string text;
  if (peaks.rotation.value > smallRotation)
    text += "; bodies have turned by " + digits(peaks.rotation.value * 180 / M_PI) + " degrees";
  if (peaks.strain.value > smallStrain)
    text += "; strains have reached " + digits(100 * peaks.strain.value) + " %";
  return text.empty() ? "" : text + ", taken as small";
}

/// Why the run cannot go on where a node has slid past the end of the line that it touches; empty where none
/// has.
std::string followSliding(const Model& model, const State& state, const TimePlan& plan, RunReport& run) {
  std::string why;
  for (size_t k = 0; k < model.interfaces.size(); ++k) {
    if (model.interfaces[k].follows()) continue;
    const Sliding sliding = slidingOf(model, state, k);
    run.peaks.sliding.raise(sliding.edges, state.time);
    const bool allowed = k >= plan.slidingAllowed.size() || plan.slidingAllowed[k];
    if (sliding.past < 0 || allowed || !why.empty()) continue;
    const ContactPair& pair = model.interfaces[k].pair();
    const Body& body = model.bodies[pair.nonmortar.body];
    const Point& at = body.elementNodes().places[sliding.past];
    why = formatted("step %d at t = %g: contact of label %d of body ", run.steps, state.time,
                    pair.nonmortar.label) +
          body.name() +
          formatted(": the node at (%g, %g) slides by %g, past the end of label %d of body ", at.x(), at.y(),
                    sliding.pastBy, pair.mortar.label) +
          model.bodies[pair.mortar.body].name() +
          ": the node leaves the contact line; set contact.sliding = \"finite\" (or \"allow\")";
  }
  return why;
}

/// Steps to the end, or to the first that cannot be taken.
void go(const Model& model, State& state, MarchMemory& memory, const TimePlan& plan, StepTaker& taker,
        Controller& controller, const Observer& observer) {
  RunReport& run = memory.run;
  const bool controlled = plan.controlled();
  while (run.status == Status::converged &&
         (controlled ? state.time < plan.end && !controller.abandons() : run.steps < plan.steps)) {
    const auto begin = Clock::now();
    StepReport report;
    report.step = run.steps + 1;
    const ActiveSets before = startingSets(state);
    try {
      if (controlled) {
        controller.advance(taker, state, report);
        run.timeError = controller.worst();
      } else {
        report.time = report.step == plan.steps
                          ? plan.end
                          : memory.begin + (plan.end - memory.begin) * report.step / plan.steps;
        report.timeStep = report.time - state.time;
        advance(taker, state, report.time, report);
      }
    } catch (const DatumError& error) {
      // Shorter steps would end before it, but none beyond.
      report.status = Status::failed;
      report.reason = "step " + std::to_string(report.step) + ": " + error.what();
    }
    run.solveSeconds += secondsSince(begin);
    if (report.status == Status::failed) {
      run.stuck = taker.stuck();
      if (taker.overlap().refused()) run.overlap = taker.overlap();
    }
    if (run.stuck) report.reason += taker.stressAt(*run.stuck);
    add(report, run);
    run.special = taker.special();
    raiseDeformation(model, state, run.peaks);
    if (report.status != Status::converged) {
      run.reason += beyondSmall(run.peaks);
      break;
    }
    compareActive(before, taker.active(), report);
    measure(model, state, taker.threads(), report);
    report.solutions = taker.takeSolutions();
    if (report.solutions.ambiguous) ++run.ambiguousSteps;
    if (report.solutions.listed.size() > 1)
      run.several.push_back({report.step, report.time, report.solutions.listed});
    raise(run.peaks, report);
    const std::string slid = followSliding(model, state, plan, run);
    report.quantities = evaluate(plan.quantities, model, state);
    for (size_t i = 0; i < report.quantities.size(); ++i)
      run.quantities[i].add(report.quantities[i], report.time);
    observer(state, report);
    if (slid.empty()) continue;
    run.status = Status::failed;
    run.reason = slid;
  }
}

/// Reports the state in which a run begins, with what a jump did.
void reportStart(const Model& model, const State& state, Threads& threads, MarchMemory& memory,
                 const TimePlan& plan, const Observer& observer, StepReport report = {}) {
  report.time = state.time;
  const auto atRest = [](const BodyState& body) {
    return body.displacement.isZero(0) && body.stress.isZero(0);
  };
  if (!std::all_of(state.bodies.begin(), state.bodies.end(), atRest)) {
    measure(model, state, threads, report);
    raise(memory.run.peaks, report);
  }
  for (const Vector& force : state.contactForce)
    report.active += static_cast<int>((force.array() > 0).count());
  report.quantities = evaluate(plan.quantities, model, state);
  for (const double value : report.quantities)
    memory.run.quantities.push_back(QuantityRange::from(value, state.time));
  observer(state, report);
}

/// Lets what acts in the first moment act at once. \returns what it did
StepReport jump(const Model& model, const State& state, MarchMemory& memory, StepTaker& taker) {
  RunReport& run = memory.run;
  StepReport report;
  const auto begin = Clock::now();
  try {
    if (actsAtOnce(model, state)) {
      const StepOutcome outcome = taker.jump();
      report.iterations = outcome.iterations;
      report.factorisations = outcome.factorisations;
      report.certificate = outcome.certificate;
      if (!outcome.converged()) {
        report.status = outcome.unheld() ? Status::unheld : Status::failed;
        report.reason = formatted("at t = %g: ", state.time) + outcome.detail;
      }
    }
  } catch (const DatumError& error) {
    report.status = Status::failed;
    report.reason = error.what();
  }
  if (report.status == Status::failed) run.stuck = taker.stuck();
  run.iterations += report.iterations;
  run.factorisations += report.factorisations;
  run.status = report.status;
  run.reason = report.reason;
  if (report.status == Status::converged) run.worst = worse(run.worst, report.certificate);
  report.solutions = taker.takeSolutions();
  run.solveSeconds += secondsSince(begin);
  return report;
}

/// Makes ready for steps chosen by their error: finds their scales.
void prepare(const Model& model, State& state, MarchMemory& memory, const TimePlan& plan, StepTaker& taker) {
  const auto begin = Clock::now();
  Controller controller(model, plan, memory);
  controller.pilot(taker, state);
  memory.run.solveSeconds += secondsSince(begin);
  controller.begin(state);
}

}  // namespace

State initialState(const Model& model) {
  State state;
  for (const Body& body : model.bodies) {
    const int components = body.material().components();
    BodyState initial{Vector::Zero(body.dofs()), body.initialStress(),
                      Matrix::Zero(components, body.points())};
    if (body.heated()) initial.thermalStrain = Matrix::Zero(components, body.points());
    state.bodies.push_back(std::move(initial));
  }
  for (const ContactInterface& interface : model.interfaces) {
    const ContactPair& pair = interface.pair();
    state.contactForce.push_back(Vector::Zero(interface.rows()));
    state.gap.push_back(interface.gap(state.bodies[pair.nonmortar.body].displacement,
                                      state.bodies[pair.mortar.body].displacement));
    state.frictionForce.push_back(Vector::Zero(interface.slipRows()));
    state.slipping.emplace_back(interface.hasFriction() ? interface.rows() : 0, static_cast<signed char>(0));
    state.frictionWorkOf.push_back(0);
  }
  for (const Tie& tie : model.ties) state.tieForce.push_back(Vector::Zero(tie.rows()));
  return state;
}

RunReport march(const Model& model, State& state, const TimePlan& plan, const SolverOptions& options,
                const Observer& observer) {
  MarchMemory memory;
  return march(model, state, memory, plan, options, observer);
}

RunReport march(const Model& model, State& state, MarchMemory& memory, const TimePlan& plan,
                const SolverOptions& options, const Observer& observer, const AtEnd& atEnd) {
  const bool controlled = plan.controlled();
  const bool begun = memory.run.steps > 0 || memory.controller.trial > 0;
  const bool countsWork = std::any_of(plan.quantities.begin(), plan.quantities.end(), needsWork);
  if (!begun) memory.begin = state.time;
  const auto followState = [&] {
    if (anyFollows(model)) follow(model, displacementsOf(state));
  };
  followState();
  std::optional<StepTaker> taker;
  const auto makeTaker = [&] {
    const auto begin = Clock::now();
    taker.emplace(model, state, memory, plan.scheme, options, countsWork, plan.overlapEnds);
    memory.run.solveSeconds += secondsSince(begin);
  };
  makeTaker();
  if (!begun) {
    StepReport start = jump(model, state, memory, *taker);
    const bool possible = start.status == Status::converged;
    if (possible && controlled) prepare(model, state, memory, plan, *taker);
    followState();  // prepare() has taken steps
    reportStart(model, state, taker->threads(), memory, plan, observer, std::move(start));
    if (!possible) return memory.run;
    if (controlled) makeTaker();
  }
  Controller controller(model, plan, memory);
  while (true) {
    go(model, state, memory, plan, *taker, controller, observer);
    const bool again = controlled && memory.run.status == Status::converged && controller.beginAgain(state);
    if (!again) {
      if (memory.run.status == Status::converged)
        if (!taker->overlap().explained) memory.run.overlap = taker->overlap();
      if (controlled && memory.run.status == Status::converged) memory.run.shortfall = controller.shortfall();
      if (atEnd && memory.run.status == Status::converged) atEnd(*taker);
      return memory.run;
    }
    followState();
    reportStart(model, state, taker->threads(), memory, plan, observer);
    makeTaker();
  }
}

}  // namespace mortier
