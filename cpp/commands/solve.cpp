#include "commands/solve.h"

#include <algorithm>

#include "base/checksum.h"
#include "base/error.h"
#include "base/interrupt.h"
#include "base/ranks.h"
#include "report/checkpoint_files.h"
#include "report/clock.h"
#include "solver/threads_for.h"

namespace mortier {

Checkpoints::Checkpoints(std::string folder, double interval, RunIdentity identity)
    : folder_(std::move(folder)),
      interval_(interval),
      last_(processSeconds()),
      identity_(std::move(identity)) {}

bool Checkpoints::due() const {
  constexpr double rarely = 10;
  return processSeconds() - last_ >= (interval_ > 0 ? std::max(interval_, rarely * cost_) : 0);
}

void Checkpoints::write(const FilesSoFar& empty, const FilesSoFar& files, const StepReport& last,
                        const State& state, const MarchMemory& memory, const AccuracyMemory& accuracy) {
  const double begin = processSeconds();
  writeCheckpoint(folder_, {identity_, empty, files, last, state, memory, accuracy});
  last_ = processSeconds();
  cost_ = last_ - begin;
}

Solved solve(Solving solving) {
  const SceneDescription& scene = solving.scene;
  const Model& model = solving.model;
  const RunFacts& facts = solving.facts;
  const std::string& folder = solving.folder;
  Log& log = solving.log;
  Solved solved;
  StepReport& last = solved.last;
  State& state = solved.state;
  const bool writes = Ranks::all().first();
  std::optional<ResultFiles> files;  // where this rank writes
  FilesSoFar empty;
  MarchMemory memory;
  AccuracyMemory accuracySoFar;
  if (solving.stopped) {
    Checkpoint& stopped = *solving.stopped;
    if (writes) files.emplace(folder, model, solving.error, scene.every, stopped.files);
    empty = stopped.empty;
    last = stopped.last;
    state = std::move(stopped.state);
    memory = std::move(stopped.memory);
    accuracySoFar = stopped.accuracy;
  } else {
    if (writes) files.emplace(folder, model, solving.error, facts.quantities, facts.units, scene.every);
    state = std::move(solving.state);
  }
  solving.error.moveTo(state);
  AccuracyRecord accuracies(model, solving.error, accuracySoFar);
  std::optional<FlowBoundRecord> flow;
  std::optional<TotalBoundRecord> total;
  if (scene.accuracy.bound && FlowBoundRecord::applies(model)) {
    flow.emplace(model, Steps{scene.time.scheme == Scheme::backwardEuler, scene.time.controlled()}, state,
                 accuracySoFar.flow);
    total.emplace(model, state, accuracySoFar.total);
  }

  Threads threads(threadsFor(model, facts.threads));
  // A failure leaves the last good step in `state`, an interruption in what is kept here.
  State keptState = state;
  MarchMemory keptMemory = memory;
  const auto save = [&](const FilesSoFar& written, const State& at, const MarchMemory& with) {
    if (writes) solving.checkpoints.write(empty, written, last, at, with, accuracySoFar);
  };
  const Observer observe = [&](const State&, const StepReport& report) {
    if (total) total->look(state, report.step);  // what may be interrupted comes first
    solving.error.moveTo(state);
    const bool again = report.step == 0 && memory.controller.trial > 1;
    if (again) {
      // A checkpoint before the files are cut: one that knows them as they were would be of no use.
      log.print(logTrial(keptMemory.run.timeError, scene.time.tolerance));
      last = report;
      accuracySoFar = {};
      const FilesSoFar written = files ? files->sync() : empty;
      if (!solving.onlyTheStart) save(empty, state, memory);
      files.reset();
      removeFields(folder, written, empty);
      if (writes) files.emplace(folder, model, solving.error, scene.every, empty);
    } else {
      if (files) files->add(state, report);
      if (files && report.step == 0) empty = files->sync();
      if (report.step == 0 && solving.onlyTheStart && facts.rounds.empty()) {
        const FileRecord nothing{0, Checksum().value};  // whatever later rounds write
        save({nothing, nothing, {}}, state, memory);
      }
    }
    accuracies.add(report, scene.every > 0 && report.step % scene.every == 0);
    if (solving.alsoObserve) solving.alsoObserve(state, report);
    if (report.step > 0) log.step(report);
    last = report;
    if (flow) {
      flow->add(state, report);
      total->add(accuracySoFar.flow.obstacle);
    }
    if (files && !solving.onlyTheStart && report.step > 0 && state.time < scene.time.end &&
        solving.checkpoints.due())
      save(files->sync(), state, memory);
    threads.forEach(2, [&](int i) {
      if (i == 0)
        keptState = state;
      else
        keptMemory = memory;
    });
  };
  RunReport& report = solved.report;
  const auto saveLast = [&] {
    log.finish();
    const bool begun = last.step > 0 || keptMemory.controller.trial > 1;
    if (files && begun && !solving.onlyTheStart) save(files->sync(), keptState, keptMemory);
  };
  try {
    report = march(model, state, memory, scene.time, scene.solver, observe);
  } catch (const OutputError& error) {
    log.finish();
    if (!hasCheckpoint(folder)) throw;
    throw OutputError(error.what() + solving.again);
  } catch (const TimeIsUp&) {
    report = keptMemory.run;
    report.status = Status::failed;
    report.reason = timeIsUp;
    state = keptState;
  } catch (const PeerEnded&) {
    saveLast();
    throw;
  } catch (const Interrupted&) {
    saveLast();
    throw InterruptedError(scene.path + ": interrupted after step " + std::to_string(last.step) +
                           (hasCheckpoint(folder) ? solving.again : "; nothing was written"));
  }
  log.finish();
  if (files) solved.files = files->close(state, last.step);
  solved.accuracy = accuracies.atEnd(report.peaks);
  if (flow) {
    solved.accuracy.flow = flow->atEnd(state);
    solved.accuracy.total = total->atEnd(state, *solved.accuracy.flow);
  }
  return solved;
}

}  // namespace mortier
