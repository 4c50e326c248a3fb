// `mortier run`: solves a scene and writes its result.
#include <unistd.h>

#include <CLI/CLI.hpp>
#include <atomic>
#include <cmath>
#include <csignal>
#include <cstdlib>
#include <cstring>
#include <filesystem>
#include <memory>

#include "base/error.h"
#include "base/interrupt.h"
#include "commands/run.h"
#include "lint/lint.h"
#include "scene/keys.h"

namespace mortier {

namespace fs = std::filesystem;

namespace {

struct RunCommand : SceneOptions {
  std::string restart;  ///< folder of the result of a stopped run to resume; empty: a new run
  RunOptions options;   ///< `out` empty: out/<scene>
};

/// What a signal says that ends the process at once.
std::atomic<const char*> atOnce = nullptr;

/// The first Ctrl-C ends the run with a checkpoint of its last step; a second one kills, and so does the
/// first where a library would not hear of it (before the first step).
void onInterrupt(int signal) {
  if (inUninterruptibleCall()) {
    static_cast<void>(!write(STDERR_FILENO, atOnce, std::strlen(atOnce)));
    _exit(exitFailed);
  }
  if (!Ranks::all().interrupt()) requestInterrupt();
  std::signal(signal, SIG_DFL);
}

std::string defaultFolder(const std::string& scene) {
  return (fs::path("out") / fs::path(scene).stem()).string();
}

/// The warnings of `mortier check`, in its words.
void warnOf(const Faults& faults) {
  for (const Fault& fault : faults.all())
    if (fault.kind->severity == Severity::warning) warn(fault.place + ": " + withRemedy(fault));
}

/// Goes to the folder in which the run was begun, with the options of that run.
void repeatRequest(const RunIdentity& stored, RunCommand& command) {
  std::error_code error;
  command.restart = fs::absolute(command.restart).string();
  fs::current_path(stored.workingFolder, error);
  if (error)
    throw InputError(command.restart + ": begun in " + stored.workingFolder +
                     ", which is not there, expected SCENE.toml and its --set as well");
  command.scene = stored.scene;
  command.settings = stored.settings;
}

/// The stopped run that --restart names, on all ranks; none when the run was complete.
std::optional<StoppedRun> stoppedRun(const std::string& restart) {
  Ranks& ranks = Ranks::all();
  std::optional<StoppedRun> stopped;
  if (ranks.first()) stopped = findStoppedRun(restart);
  const std::string folder = textOfFirst(ranks, stopped ? stopped->folder : "");
  if (!ranks.first() && !folder.empty()) stopped = StoppedRun{folder, {}, readCheckpoint(folder)};
  return stopped;
}

/// \returns the exit code. \throws InputError, UnheldBodyError, OutputError, InterruptedError
int runScene(RunCommand command) {
  // 1. The scene, and the model it describes.
  std::optional<StoppedRun> stopped;
  if (!command.restart.empty()) {
    stopped = stoppedRun(command.restart);
    if (!stopped) {
      warn(command.restart + ": the run was complete, its result is now in place");
      return exitDone;
    }
    if (command.scene.empty()) repeatRequest(stopped->checkpoint.identity, command);
    command.options.out = command.restart;
  }
  if (command.options.out.empty()) command.options.out = defaultFolder(command.scene);
  ResolvedScene resolved = resolveScene(readScene(command.scene, command.settings));
  Faults doubts = lintResolved(resolved);
  Run run(std::move(resolved), command.options, std::move(stopped));
  if (run.waitsForFirstRank()) return exitDone;
  const SceneDescription& scene = run.attempt()->scene();
  if (Ranks::all().first()) lintModel(scene, *run.attempt()->model, doubts);
  lintSettling(scene, run.settle(), doubts);

  // 2. Where the result goes, and what is reported.
  atOnce = "mortier: interrupted before the first step; nothing was written\n";
  for (const int signal : {SIGINT, SIGTERM, SIGHUP}) std::signal(signal, onInterrupt);
  run.open();
  const double end = scene.time.end;
  const bool inRounds = scene.accuracy.asked() > 0;
  warnOf(doubts);
  if (!command.restart.empty() && !run.resumes()) warn(command.restart + ": the rounds begin again");

  // 3. The march in time; where an accuracy is asked for, in rounds.
  static std::string betweenRounds;
  betweenRounds = "mortier: " + run.interruptedBetweenRounds() + "\n";
  run.solve([&](const auto&, const State& state, const StepReport&) {
    if (inRounds && state.time >= end) atOnce = betweenRounds.c_str();
  });

  // 4. The result in place of an older one, and how well it holds.
  const Ending ending = run.finish();
  if (!ending.reason.empty()) complain(ending.reason);
  return ending.code;
}

}  // namespace

Command addRun(CLI::App& app) {
  const auto command = std::make_shared<RunCommand>();
  RunOptions& options = command->options;
  options.quiet = false;
  CLI::App* run = app.add_subcommand("run", "solve a scene (docs/scene.md) and write its result");
  command->addScene(*run);
  CLI::Option* out =
      run->add_option("--out", options.out, "folder of the result (default: out/ and the scene's name)");
  out->type_name("DIR");
  run->add_option("--restart", command->restart, "resume the interrupted run that was writing to DIR")
      ->type_name("DIR")
      ->excludes(out);
  run->add_option("--checkpoint", options.checkpoint,
                  "wall time between checkpoints [s] (default 30; 0: after every step)")
      ->check([](const std::string& text) {
        const double seconds = std::strtod(text.c_str(), nullptr);
        return std::isfinite(seconds) && seconds >= 0 ? std::string() : text + ", expected a number >= 0";
      })
      ->type_name("SECONDS");
  command->addSettings(*run);
  command->addGoal(*run, "--accuracy", "energy", "E");
  command->addGoal(*run, "--max-unknowns", "max_unknowns", "N");
  command->addGoal(*run, "--max-seconds", "max_seconds", "SECONDS");
  run->add_option("--threads", options.threads, "threads (default 1)")
      ->check(CLI::Range(1, 1024))
      ->type_name("N");
  run->add_flag_callback(
      "--list-solutions", [=] { command->settings.emplace_back("solver.list_solutions=true"); },
      helpOf(keyAt("solver", "list_solutions")));
  run->add_flag("--quiet", options.quiet, "no log and no progress bar");
  return {run, [command] {
            if (command->restart.empty() || !command->settings.empty()) command->requireScene();
            return runScene(*command);
          }};
}

}  // namespace mortier
