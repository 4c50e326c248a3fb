#include "commands/solve.h"

#include <algorithm>

#include "base/checksum.h"
#include "base/error.h"
#include "base/interrupt.h"
#include "base/ranks.h"
#include "bound/total_bound.h"
#include "commands/bound_of.h"
#include "report/checkpoint_files.h"
#include "report/clock.h"
#include "solver/threads_for.h"
#include "time/parts_of_run.h"

namespace mortier {

Checkpoints::Checkpoints(std::string folder, double interval, RunIdentity identity)
    : folder_(std::move(folder)),
      interval_(interval),
      last_(processSeconds()),
      identity_(std::move(identity)) {}

bool Checkpoints::due() const {
  constexpr double rarely = 10;
  return !folder_.empty() &&
         processSeconds() - last_ >= (interval_ > 0 ? std::max(interval_, rarely * cost_) : 0);
}

void Checkpoints::write(const FilesSoFar& empty, const FilesSoFar& files, const StepReport& last,
                        const State& state, const MarchMemory& memory, const AccuracyMemory& accuracy) {
  if (folder_.empty()) return;
  const double begin = processSeconds();
  writeCheckpoint(folder_, {identity_, empty, files, last, state, memory, accuracy});
  last_ = processSeconds();
  cost_ = last_ - begin;
}

namespace {

/// The state and the memory of whole bodies, from those of this rank. Gathered where they are in parts.
class WholeRun {
 public:
  explicit WholeRun(const Model& model) : model_(model) {}
  [[nodiscard]] const State& state(const State& own) {
    if (!model_.inParts()) return own;
    return state_.emplace(gathered(model_, own));
  }
  [[nodiscard]] const MarchMemory& memory(const MarchMemory& own) {
    if (!model_.inParts()) return own;
    return memory_.emplace(gathered(model_, own));
  }
  void forget() {
    state_.reset();
    memory_.reset();
    if (model_.inParts()) model_.ranks->releaseFreeMemory();
  }

 private:
  const Model& model_;
  std::optional<State> state_;
  std::optional<MarchMemory> memory_;
};

}  // namespace

Solved solve(Solving solving) {
  const SceneDescription& scene = solving.scene;
  const Model& model = solving.model;
  const bool inParts = solving.solvedModel.inParts();
  const RunFacts& facts = solving.facts;
  const std::string& folder = solving.folder;
  Log& log = solving.log;
  Solved solved;
  StepReport& last = solved.last;
  State& state = solved.state;
  const bool writes = Ranks::all().first();
  const bool toFiles = writes && !folder.empty();
  std::optional<ResultFiles> files;  // where this rank writes
  FilesSoFar empty;
  MarchMemory memory;
  AccuracyMemory accuracySoFar;
  if (solving.stopped) {
    Checkpoint& stopped = *solving.stopped;
    if (toFiles) files.emplace(folder, model, solving.error, scene.every, stopped.files);
    empty = stopped.empty;
    last = stopped.last;
    state = inParts ? ofParts(solving.solvedModel, stopped.state) : std::move(stopped.state);
    memory = inParts ? ofParts(solving.solvedModel, stopped.memory) : std::move(stopped.memory);
    accuracySoFar = stopped.accuracy;
    solving.stopped.reset();
  } else {
    if (toFiles) files.emplace(folder, model, solving.error, facts.quantities, facts.units, scene.every);
    state = std::move(solving.state);
  }
  if (!inParts) solving.error.moveTo(state);
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
  WholeRun whole(solving.solvedModel);
  const auto save = [&](const FilesSoFar& written, const State& at, const MarchMemory& with) {
    const State& wholeState = whole.state(at);
    const MarchMemory& wholeMemory = whole.memory(with);
    if (writes) solving.checkpoints.write(empty, written, last, wholeState, wholeMemory, accuracySoFar);
    whole.forget();
  };
  const Observer observe = [&](const State&, const StepReport& report) {
    if (total) total->look(state, report.step);  // what may be interrupted comes first
    const bool again = report.step == 0 && memory.controller.trial > 1;
    const bool kept = scene.every > 0 && report.step % scene.every == 0;
    const bool mayBeSaved =
        !solving.checkpointInitialStateOnly && report.step > 0 && state.time < scene.time.end;
    // What the first rank asks of all of them.
    const auto asked = [&](bool own) { return inParts ? numberOfFirst(Ranks::all(), own ? 1 : 0) > 0 : own; };
    if (again) {
      // A checkpoint before the files are cut: one that knows them as they were would be of no use.
      log.print(logTrial(keptMemory.run.timeError, scene.time.tolerance));
      last = report;
      accuracySoFar = {};
      const FilesSoFar written = files ? files->sync() : empty;
      if (!solving.checkpointInitialStateOnly) save(empty, state, memory);
      files.reset();
      removeFields(folder, written, empty);
      if (toFiles) files.emplace(folder, model, solving.error, scene.every, empty);
    }
    if (asked(kept || accuracies.asks(report, kept))) {
      const State& at = whole.state(state);
      if (writes) solving.error.moveTo(at);
      if (files && !again) files->add(at, report);
      if (writes) accuracies.add(report, kept);
      if (inParts) whole.forget();
    } else {
      solving.error.moveTo(state);
      if (files && !again) files->add(state, report);
    }
    if (!again) {
      if (files && report.step == 0) empty = files->sync();
      if (report.step == 0 && solving.checkpointInitialStateOnly && facts.rounds.empty()) {
        const FileRecord nothing{0, Checksum().value};  // whatever later rounds write
        save({nothing, nothing, {}}, state, memory);
      }
    }
    if (solving.alsoObserve) solving.alsoObserve(state, report);
    if (hasRow(report)) log.step(report);
    last = report;
    if (flow) {
      flow->add(state, report);
      total->add(accuracySoFar.flow.obstacle);
    }
    if (asked(mayBeSaved && files && solving.checkpoints.due()))
      save(files ? files->sync() : empty, state, memory);
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
    if (!begun || solving.checkpointInitialStateOnly || (inParts && !Ranks::all().answer())) return;
    save(files ? files->sync() : empty, keptState, keptMemory);
  };
  try {
    report = march(solving.solvedModel, state, memory, scene.time, scene.solver, observe);
  } catch (const OutputError& error) {
    log.finish();
    if (folder.empty() || !hasCheckpoint(folder)) throw;
    throw OutputError(error.what() + solving.again);
  } catch (const TimeIsUp&) {
    report = keptMemory.run;
    report.status = Status::failed;
    report.reason = timeIsUp;
    state = keptState;
  } catch (const PeerEnded&) {
    if (!inParts) saveLast();
    throw;
  } catch (const Interrupted&) {
    try {
      saveLast();
    } catch (const Interrupted&) {  // some no longer answer: the checkpoint before holds
    }
    const std::string resume = folder.empty()          ? ""
                               : hasCheckpoint(folder) ? solving.again
                                                       : "; nothing was written";
    throw InterruptedError(scene.path + ": interrupted after step " + std::to_string(last.step) + resume);
  }
  log.finish();
  keptState = {};
  keptMemory = {};
  if (inParts) state = gathered(solving.solvedModel, state);
  if (!writes) return solved;
  if (inParts) solving.error.moveTo(state);  // elsewhere it is at the last step
  if (files) solved.files = files->close(state, last.step);
  solved.accuracy = accuracies.atEnd(report.peaks);
  if (flow) {
    solved.accuracy.flow = flowBoundOf(*flow, state);
    solved.accuracy.total = totalBoundOf(*total, state, *solved.accuracy.flow);
  }
  return solved;
}

}  // namespace mortier
