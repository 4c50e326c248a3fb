#include "commands/run.h"

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
#include "plan/estimate_doubts.h"
#include "report/accuracy.h"
#include "report/checkpoint.h"
#include "report/checkpoint_files.h"
#include "report/clock.h"
#include "report/log.h"
#include "report/output_folder.h"
#include "report/result_files.h"
#include "report/summary.h"
#include "scene/build.h"
#include "scene/load_courses.h"
#include "scene/memory_need.h"
#include "scene/settle.h"
#include "scene/versions.h"

namespace mortier {

namespace {

/// The first Ctrl-C ends the run with a checkpoint of its last step; a second one kills.
void onInterrupt(int signal) {
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
  for (const BodyDescription& body : scene.bodies) {
    std::vector<const MaterialDescription*> materials{&body.material};
    for (const RegionDescription& region : body.regions) {
      if (region.material) {
        materials.push_back(&*region.material);
      }
    }
    std::vector<std::string> words;
    for (const MaterialDescription* material : materials) {
      const auto& flow = material->viscoplasticity;
      // In plane strain all projections are one.
      const std::string law =
          scene.plane == Plane::strain || !flow ? "Perzyna" : "Perzyna (" + word(flow->projection) + ")";
      words.push_back(flow ? law : "elastic");
      if (flow) {
        projections.push_back(word(flow->projection));
      }
    }
    facts.materials.push_back(joinedOnce(words));
  }
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

/// Crank-Nicolson multiplies an overstress by almost -1 in every step of a stiff scene.
void warnOfRinging(const SceneDescription& scene, const Model& model) {
  constexpr double ringing = 10;
  if (scene.time.scheme != Scheme::crankNicolson) return;
  const double weight = scene.time.end / scene.time.steps / 2;
  double stiffness = 0;
  for (const Body& body : model.bodies) stiffness = std::max(stiffness, body.material().stiffness(weight));
  if (stiffness <= ringing) return;
  char ratio[32];
  std::snprintf(ratio, sizeof ratio, "%.1e", 2 * stiffness);
  warn(scene.path + ": scheme = crank-nicolson rings here (step over relaxation time " + ratio +
       "); sdirk2 is of second order too and does not");
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
  void write(ResultFiles& files, const StepReport& last, const State& state, const MarchMemory& memory,
             const AccuracyMemory& accuracy) {
    const double begin = processSeconds();
    writeCheckpoint(folder_, {identity_, files.sync(), last, state, memory, accuracy});
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
  std::vector<std::string> warnings;
  const Model model = buildModel(resolved, warnings);
  SceneDescription& scene = resolved.description;
  scene.solver.threads = command.threads;
  for (auto warning = warnings.begin(); warning != warnings.end(); ++warning)  // of several components once
    if (std::find(warnings.begin(), warning, *warning) == warning) warn(*warning);

  warnOfRinging(scene, model);
  addMeshes(model, identity);
  if (stopped) {
    requireSame(stopped->checkpoint.identity, identity, stopped->folder);
    requireFits(stopped->checkpoint, model, stopped->folder);
  }
  if (scene.time.tolerance > 0) {
    LoadCourses loads = loadCourses(scene, model);
    scene.time.breaks = std::move(loads.breaks);
    scene.time.data = std::move(loads.data);
  } else {
    for (const std::string& warning : loadsBetweenSteps(scene, model)) warn(warning);
  }

  // 2. Where the result goes, and what is reported.
  const std::string path = command.out.empty() ? defaultFolder(command.scene) : command.out;
  std::optional<OutputFolder> folder;
  std::optional<ResultFiles> files;
  StepReport last;
  State state = initialState(model);
  if (!stopped)
    if (const std::string doubt = settle(scene, model, state); !doubt.empty())
      warn(scene.path + ": " + doubt);
  MarchMemory memory;
  AccuracyMemory accuracySoFar;
  for (const int signal : {SIGINT, SIGTERM, SIGHUP}) std::signal(signal, onInterrupt);
  if (stopped) {
    folder.emplace(path, stopped->folder, std::move(stopped->lock));
    files.emplace(folder->temporary(), model, scene.every, stopped->checkpoint.files);
    last = stopped->checkpoint.last;
    state = std::move(stopped->checkpoint.state);
    memory = std::move(stopped->checkpoint.memory);
    accuracySoFar = stopped->checkpoint.accuracy;
  } else {
    folder.emplace(path);
    files.emplace(folder->temporary(), model, scene.every);
  }
  Checkpoints checkpoints(folder->temporary(), command.checkpoint, std::move(identity));
  RunFacts facts = factsOf(command, scene);
  facts.doubts = estimateDoubts(scene, model);
  AccuracyRecord accuracies(model, accuracySoFar);
  Log log(command.quiet, scene.time.end);
  log.print("memory     " + aboutMemory(memoryNeed(model)) + "\n");
  log.print(logHeader(facts, model));

  // 3. The march in time. A failure leaves the last good step in `state`, an interruption in what is kept here.
  State keptState = state;
  MarchMemory keptMemory = memory;
  const Observer observe = [&](const State&, const StepReport& report) {
    files->add(state, report);
    accuracies.add(state, report, scene.every > 0 && report.step % scene.every == 0);
    if (report.step > 0) log.step(report);
    last = report;
    if (report.step > 0 && state.time < scene.time.end && checkpoints.due()) {
      checkpoints.write(*files, last, state, memory, accuracySoFar);
    }
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
    if (last.step > 0) checkpoints.write(*files, last, keptState, keptMemory, accuracySoFar);
    throw InterruptedError(
        scene.path + ": interrupted after step " + std::to_string(last.step) +
        (last.step == 0 ? "; nothing was written" : "; mortier run --restart " + path + " goes on"));
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
  if (!complete) {
    complain(scene.path + ": " + report.reason + "; the state after step " + std::to_string(last.step) +
             " is in " + where);
  }
  return complete ? exitDone : report.status == Status::unheld ? exitUnheld : exitFailed;
}

}  // namespace mortier
