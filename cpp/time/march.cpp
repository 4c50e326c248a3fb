#include "time/march.h"

#include <algorithm>
#include <chrono>
#include <optional>
#include <sstream>

#include "time/controller.h"
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
    const StepOutcome outcome = taker.attempt(time, parts == 1 ? Effort::all : Effort::usual);
    report.iterations += outcome.iterations;
    report.factorisations += outcome.factorisations;
    if (outcome.rung != "newton" && report.rung == "newton") report.rung = outcome.rung;
    if (outcome.converged) {
      report.certificate = worse(report.certificate, outcome.certificate);
      report.guarded = report.guarded || taker.guarded();
      taker.commit();
      ++done;
      continue;
    }
    if (outcome.unheld || parts == smallest) {
      report.status = outcome.unheld ? Status::unheld : Status::failed;
      std::ostringstream reason;
      reason << "step " << report.step << " at t = " << time << " s: " << outcome.reason;
      report.reason = reason.str();
      return;
    }
    parts *= 2;
    done *= 2;
    ++report.rejections;
    report.rung = "cut";
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
  ++run.rungs[report.rung];
  run.guarded += report.guarded ? 1 : 0;
  run.worst = worse(run.worst, report.certificate);
}

}  // namespace

State initialState(const Model& model) {
  State state;
  for (const Body& body : model.bodies) {
    const int components = body.material().components();
    BodyState initial{Vector::Zero(body.dofs()), body.initialStress(),
                      Matrix::Zero(components, body.points())};
    body.prescribe(0, initial.displacement);
    state.bodies.push_back(std::move(initial));
  }
  for (const ContactInterface& interface : model.interfaces) {
    const ContactPair& pair = interface.pair();
    state.contactForce.push_back(Vector::Zero(interface.rows()));
    state.gap.push_back(interface.gap(state.bodies[pair.nonmortar.body].displacement,
                                      state.bodies[pair.mortar.body].displacement));
  }
  return state;
}

RunReport march(const Model& model, State& state, const TimePlan& plan, const SolverOptions& options,
                const Observer& observer) {
  MarchMemory memory;
  return march(model, state, memory, plan, options, observer);
}

RunReport march(const Model& model, State& state, MarchMemory& memory, const TimePlan& plan,
                const SolverOptions& options, const Observer& observer) {
  using Clock = std::chrono::steady_clock;
  RunReport& run = memory.run;
  const auto timed = [&](auto work) {
    const auto begin = Clock::now();
    work();
    run.solveSeconds += std::chrono::duration<double>(Clock::now() - begin).count();
  };

  const bool controlled = plan.tolerance > 0;
  if (run.steps == 0) memory.begin = state.time;
  std::optional<StepTaker> taker;
  std::optional<Controller> controller;
  timed([&] {
    taker.emplace(model, state, memory, plan.scheme, options);
    if (!controlled) return;
    controller.emplace(model, plan, memory);
    if (run.steps == 0) controller->pilot(*taker, state);
  });
  if (run.steps == 0) observer(state, StepReport{});
  while (run.status == Status::converged && (controlled ? state.time < plan.end : run.steps < plan.steps)) {
    StepReport report;
    report.step = run.steps + 1;
    const ActiveSets before = startingSets(state);
    timed([&] {
      if (controlled) return controller->advance(*taker, state, report);
      report.time = memory.begin + (plan.end - memory.begin) * report.step / plan.steps;
      report.timeStep = report.time - state.time;
      advance(*taker, state, report.time, report);
    });
    add(report, run);
    run.special = taker->special();
    if (report.status != Status::converged) break;
    compareActive(before, taker->active(), report);
    measure(model, state, report);
    raise(run.peaks, report);
    observer(state, report);
  }
  return run;
}

}  // namespace mortier
