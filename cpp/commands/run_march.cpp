// One march of a run with what goes with it: the files of the result, checkpoints, the log.
#include <algorithm>

#include "base/checksum.h"
#include "base/error.h"
#include "base/interrupt.h"
#include "commands/run.h"
#include "report/clock.h"
#include "report/result_files.h"
#include "solver/model.h"

namespace mortier {

/// At intervals of wall time, and never so often that a tenth of the time goes into them.
bool Run::checkpointIsDue() const {
  constexpr double rarely = 10;
  const double interval =
      options_.checkpoint > 0 ? std::max(options_.checkpoint, rarely * checkpointCost_) : 0;
  return !temporary_.empty() && processSeconds() - lastCheckpoint_ >= interval;
}

void Run::writeCheckpoint(const Checkpoint& checkpoint) {
  if (temporary_.empty()) return;
  const double begin = processSeconds();
  mortier::writeCheckpoint(temporary_, checkpoint);
  lastCheckpoint_ = processSeconds();
  checkpointCost_ = lastCheckpoint_ - begin;
}

void Run::march(const std::shared_ptr<Attempt>& attempt, const Observer& alsoObserve) {
  Attempt& now = *attempt;
  const SceneDescription& scene = now.scene();
  const Model& model = *now.model;
  const bool toFiles = !temporary_.empty();
  CurrentMeshError& error = *now.error;
  Solved& solved = now.solved;
  StepReport& last = solved.last;
  State& state = solved.state;
  std::optional<ResultFiles> files;
  FilesSoFar empty;  // before the first step
  MarchMemory memory;
  AccuracyMemory accuracySoFar;
  if (resumes()) {
    Checkpoint stopped = std::move(stopped_->checkpoint);
    if (toFiles) files.emplace(temporary_, model, error, stopped.files);
    empty = stopped.empty;
    last = stopped.last;
    state = std::move(stopped.state);
    memory = std::move(stopped.memory);
    accuracySoFar = stopped.accuracy;
  } else if (toFiles) {
    files.emplace(temporary_, model, error, now.facts.quantities, now.facts.units);
  }
  error.moveTo(state);
  AccuracyRecord accuracies(model, error, accuracySoFar);

  Threads threads(threadsFor(model, now.facts.threads));
  // A failure leaves the last good step in `state`, an interruption in what is kept here.
  State keptState = state;
  MarchMemory keptMemory = memory;
  const auto save = [&](const FilesSoFar& written, const State& at, const MarchMemory& with) {
    writeCheckpoint({identity_, empty, written, last, at, with, accuracySoFar});
  };
  const Observer observe = [&](const State&, const StepReport& report) {
    const bool restarted = report.step == 0 && memory.controller.trial > 1;
    const bool kept = scene.every > 0 && report.step % scene.every == 0;
    const bool mayBeSaved = !rounds_ && report.step > 0 && state.time < scene.time.end;
    if (restarted) {
      // The checkpoint before the files are cut: one with their old lengths would be of no use.
      rows_.print(logTrial(keptMemory.run.timeError, scene.time.tolerance));
      last = report;
      accuracySoFar = {};
      const FilesSoFar written = files ? files->sync() : empty;
      if (!rounds_) save(empty, state, memory);
      files.reset();
      removeFields(temporary_, written, empty);
      if (toFiles) files.emplace(temporary_, model, error, empty);
    }
    error.moveTo(state);
    if (files && !restarted) files->add(state, report, kept);
    if (kept || accuracies.needs(report, kept)) accuracies.add(report, kept);
    if (!restarted && report.step == 0) {
      if (files) empty = files->sync();
      if (rounds_ && now.facts.rounds.empty()) {  // whatever later rounds write, one checkpoint serves them
        const FileRecord emptyFile{0, Checksum().value};
        save({emptyFile, emptyFile, {}}, state, memory);
      }
    }
    if (alsoObserve) alsoObserve(state, report);
    if (observe_) observe_(attempt, state, report);
    if (hasRow(report)) rows_.step(report);
    rows_.print(asLines(deformationWarnings(memory.run.peaks, now.facts.units, keptMemory.run.peaks)));
    last = report;
    if (mayBeSaved && files && checkpointIsDue()) save(files->sync(), state, memory);
    threads.forEach(2, [&](int i) {
      if (i == 0)
        keptState = state;
      else
        keptMemory = memory;
    });
  };
  RunReport& report = solved.report;
  const auto saveLast = [&] {
    rows_.finish();
    const bool begun = last.step > 0 || keptMemory.controller.trial > 1;
    if (!begun || rounds_) return;
    save(files ? files->sync() : empty, keptState, keptMemory);
  };
  std::vector<QuantityError>& errors = solved.accuracy.quantities;
  const AtEnd atEnd = [&](StepTaker& taker) {
    errors = quantityErrors(now.facts.quantities, model, &taker, memory.begin, error);
  };
  try {
    report = mortier::march(model, state, memory, scene.time, scene.solver, observe, atEnd);
  } catch (const OutputError& fault) {
    rows_.finish();
    if (temporary_.empty() || !hasCheckpoint(temporary_)) throw;
    throw OutputError(fault.what() + resumeHint_);
  } catch (const TimeIsUp&) {
    report = keptMemory.run;
    report.status = Status::failed;
    report.reason = timeIsUp;
    state = keptState;
  } catch (const Interrupted&) {
    saveLast();
    const std::string resume = temporary_.empty()          ? ""
                               : hasCheckpoint(temporary_) ? resumeHint_
                                                           : "; nothing was written";
    throw InterruptedError(scene.path + ": interrupted after step " + std::to_string(last.step) + resume);
  }
  rows_.finish();
  keptState = {};
  keptMemory = {};
  if (files) solved.files = files->close(state, last.step);
  solved.accuracy = accuracies.atEnd(report.peaks, std::move(errors), now.facts.quantities, last.quantities);
}

}  // namespace mortier
