#include "commands/run.h"

#include <unistd.h>

#include <algorithm>
#include <csignal>
#include <cstdio>
#include <filesystem>
#include <optional>

#include "base/error.h"
#include "base/interrupt.h"
#include "commands/complain.h"
#include "commands/exit_code.h"
#include "commands/stopped_run.h"
#include "commands/version.h"
#include "linear/versions.h"
#include "lint/lint.h"
#include "plan/estimate_doubts.h"
#include "plan/loads.h"
#include "report/accuracy.h"
#include "report/checkpoint.h"
#include "report/checkpoint_files.h"
#include "report/clock.h"
#include "report/log.h"
#include "report/output_folder.h"
#include "report/result_files.h"
#include "report/summary.h"
#include "scene/build.h"
#include "scene/build_quantities.h"
#include "scene/initial_equilibrium.h"
#include "scene/load_courses.h"
#include "scene/memory_need.h"
#include "scene/versions.h"

namespace mortier {

namespace {

/// The first Ctrl-C ends the run with a checkpoint of its last step; a second one kills, and so does the first where a library
/// would not hear of it (before the first step).
void onInterrupt(int signal) {
  if (inDeafCall()) {
    constexpr char text[] = "mortier: interrupted before the first step; nothing was written\n";
    static_cast<void>(!write(STDERR_FILENO, text, sizeof text - 1));
    _exit(exitFailed);
  }
  requestInterrupt();
  std::signal(signal, SIG_DFL);
}

std::string joinedOnce(std::vector<std::string> words) {
  std::sort(words.begin(), words.end());
  words.erase(std::unique(words.begin(), words.end()), words.end());
  std::string text;
  for (const std::string& each : words) {
    text += (text.empty() ? "" : ", ") + each;
  }
  return text.empty() ? "none" : text;
}

RunFacts factsOf(const RunCommand& command, const SceneDescription& scene) {
  RunFacts facts;
  facts.scene = scene.path;
  facts.title = scene.title;
  facts.plane = word(scene.plane);
  facts.settings = command.settings;
  facts.scheme = word(scene.time.scheme);
  facts.plannedSteps = scene.time.steps;
  facts.tolerance = scene.time.tolerance;
  facts.threads = command.threads;
  facts.versions = {{"mortier", version}, {"compiler", __VERSION__}};
  for (const auto& libraries : {linearLibraries(), sceneLibraries()})
    facts.versions.insert(facts.versions.end(), libraries.begin(), libraries.end());
  std::vector<std::string> projections;
  for (const BodyDescription& body : scene.bodies)
    for (const MaterialDescription* material : materialsOf(body))
      if (material->viscoplasticity) projections.push_back(word(material->viscoplasticity->projection));
  std::vector<std::string> nonmortars;
  for (const ContactDescription& contact : scene.contacts) {
    facts.variants.push_back(word(contact.variant));
    facts.choices.push_back(contact.choice);
    nonmortars.push_back(contact.nonmortar.body);
  }
  facts.contact = joinedOnce(facts.variants);
  facts.nonmortar = joinedOnce(nonmortars);
  facts.projection = joinedOnce(projections);
  return facts;
}

std::string defaultFolder(const std::string& scene) {
  return (std::filesystem::path("out") / std::filesystem::path(scene).stem()).string();
}

/// The warnings of `mortier check`, in its words.
void warnOf(const Faults& faults) {
  for (const Fault& fault : faults.all())
    if (fault.kind->severity == Severity::warning) warn(fault.place + ": " + withRemedy(fault));
}

/// Writes checkpoints at intervals of wall time, and never so often that a tenth of the time goes into them.
class Checkpoints {
 public:
  Checkpoints(std::string folder, double interval, RunIdentity identity)
      : folder_(std::move(folder)),
        interval_(interval),
        last_(processSeconds()),
        identity_(std::move(identity)) {}

  [[nodiscard]] bool due() const {
    constexpr double rarely = 10;
    return processSeconds() - last_ >= (interval_ > 0 ? std::max(interval_, rarely * cost_) : 0);
  }
  /// \param empty  the files before the first step
  void write(const FilesSoFar& empty, const FilesSoFar& files, const StepReport& last, const State& state,
             const MarchMemory& memory, const AccuracyMemory& accuracy) {
    const double begin = processSeconds();
    writeCheckpoint(folder_, {identity_, empty, files, last, state, memory, accuracy});
    last_ = processSeconds();
    cost_ = last_ - begin;
  }

 private:
  std::string folder_;
  double interval_;
  double last_;
  double cost_ = 0;
  RunIdentity identity_;
};

}  // namespace

int run(RunCommand command) {
  // 1. The scene, and the model it describes.
  std::optional<StoppedRun> stopped;
  if (!command.restart.empty()) {
    stopped = findStoppedRun(command.restart);
    if (!stopped) {
      warn(command.restart + ": the run was complete, its result is now in place");
      return exitDone;
    }
    if (command.scene.empty()) askAgain(stopped->checkpoint.identity, command);
    command.out = command.restart;
  }
  RunIdentity identity = identityOf(command);
  ResolvedScene resolved = resolveScene(readScene(command.scene, command.settings));
  Faults doubts = lintResolved(resolved, command.settings);
  const Model model = buildModel(resolved);
  SceneDescription& scene = resolved.description;
  scene.solver.threads = command.threads;
  lintModel(scene, model, doubts);
  addMeshes(model, identity);
  if (stopped) {
    requireSame(stopped->checkpoint.identity, identity, stopped->folder);
    requireFits(stopped->checkpoint, model, stopped->folder);
  }
  RunFacts facts = factsOf(command, scene);
  facts.quantities = buildQuantities(scene, model);
  if (scene.time.tolerance > 0) {
    LoadCourses loads = loadCourses(scene, model);
    scene.time.breaks = std::move(loads.breaks);
    scene.time.data = std::move(loads.data);
  }

  // 2. Where the result goes, and what is reported.
  const std::string path = command.out.empty() ? defaultFolder(command.scene) : command.out;
  std::optional<OutputFolder> folder;
  std::optional<ResultFiles> files;
  FilesSoFar empty;
  StepReport last;
  State state = initialState(model);
  if (!stopped) lintSettling(scene, findInitialEquilibrium(scene, model, state), doubts);
  MarchMemory memory;
  AccuracyMemory accuracySoFar;
  for (const int signal : {SIGINT, SIGTERM, SIGHUP}) std::signal(signal, onInterrupt);
  if (stopped) {
    folder.emplace(path, stopped->folder, std::move(stopped->lock));
    files.emplace(folder->temporary(), model, facts.quantities, scene.every, stopped->checkpoint.files);
    empty = stopped->checkpoint.empty;
    last = stopped->checkpoint.last;
    state = std::move(stopped->checkpoint.state);
    memory = std::move(stopped->checkpoint.memory);
    accuracySoFar = stopped->checkpoint.accuracy;
  } else {
    folder.emplace(path);
    files.emplace(folder->temporary(), model, facts.quantities, scene.every);
  }
  facts.sceneText = identity.text;
  Checkpoints checkpoints(folder->temporary(), command.checkpoint, std::move(identity));
  facts.doubts = estimateDoubts(scene, model);
  AccuracyRecord accuracies(model, accuracySoFar);
  Log log(command.quiet, scene.time.end);
  log.print("memory     " + aboutMemory(memoryNeed(model)) + "\n");
  log.print(logHeader(facts, model));

  warnOf(doubts);

  // 3. The march in time. A failure leaves the last good step in `state`, an interruption in what is kept here.
  State keptState = state;
  MarchMemory keptMemory = memory;
  const auto save = [&](const FilesSoFar& written, const State& at, const MarchMemory& with) {
    checkpoints.write(empty, written, last, at, with, accuracySoFar);
  };
  const Observer observe = [&](const State&, const StepReport& report) {
    const bool again = report.step == 0 && memory.controller.trial > 1;
    if (again) {
      // A checkpoint before the files are cut: one that knows them as they were would be of no use.
      log.print(logTrial(keptMemory.run.timeError, scene.time.tolerance));
      last = report;
      accuracySoFar = {};
      const FilesSoFar written = files->sync();
      save(empty, state, memory);
      files.reset();
      removeFields(folder->temporary(), written, empty);
      files.emplace(folder->temporary(), model, facts.quantities, scene.every, empty);
    } else {
      files->add(state, report);
      if (report.step == 0) empty = files->sync();
    }
    accuracies.add(state, report, scene.every > 0 && report.step % scene.every == 0);
    if (report.step > 0) log.step(report);
    last = report;
    if (report.step > 0 && state.time < scene.time.end && checkpoints.due())
      save(files->sync(), state, memory);
    keptState = state;
    keptMemory = memory;
  };
  RunReport report;
  try {
    report = march(model, state, memory, scene.time, scene.solver, observe);
  } catch (const OutputError& error) {
    log.finish();
    if (!hasCheckpoint(folder->temporary())) throw;
    throw OutputError(error.what() + ("; mortier run --restart " + path + " goes on"));
  } catch (const Interrupted&) {
    log.finish();
    const bool begun = last.step > 0 || keptMemory.controller.trial > 1;
    if (begun) save(files->sync(), keptState, keptMemory);
    throw InterruptedError(
        scene.path + ": interrupted after step " + std::to_string(last.step) +
        (!begun ? "; nothing was written" : "; mortier run --restart " + path + " goes on"));
  }
  log.finish();

  // 4. The result, in place of an older one only when the run is complete.
  const bool complete = report.status == Status::converged;
  Manifest manifest{!complete, files->close(state, last.step)};
  const Accuracy accuracy = accuracies.atEnd(state, report.peaks);
  manifest.files["summary.json"] =
      writeSummary(folder->temporary(), facts, model, state, last, report, accuracy);
  const std::string where = folder->commit(manifest);

  // 5. How well it holds.
  log.print(logStatus(report, where));
  log.print(logVerification(report.worst));
  log.print(logSpecial(report.special));
  log.print(logAccuracy(facts, model, accuracy));
  log.print(logTimeError(facts, report));
  log.print(logPeaks(report.peaks, last));
  log.print(logQuantities(facts.quantities, evaluate(facts.quantities, model, state)));
  if (!complete) {
    complain(scene.path + ": " + report.reason + "; the state after step " + std::to_string(last.step) +
             " is in " + where);
  }
  return complete ? exitDone : report.status == Status::unheld ? exitUnheld : exitFailed;
}

}  // namespace mortier
