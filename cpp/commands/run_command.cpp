// `mortier run`: solves a scene and writes its result.
#include <unistd.h>

#include <CLI/CLI.hpp>
#include <atomic>
#include <cmath>
#include <csignal>
#include <cstdio>
#include <cstdlib>
#include <filesystem>
#include <memory>
#include <string_view>

#include "base/error.h"
#include "base/interrupt.h"
#include "commands/run.h"
#include "linear/distributed_engine.h"
#include "lint/lint.h"
#include "scene/keys.h"

namespace mortier {

namespace fs = std::filesystem;

namespace {

struct RunCommand : SceneOptions {
  std::string restart;  ///< folder of the result of a stopped run to resume; empty: a new run
  RunOptions options;   ///< `out` empty: out/<scene>
};

/// Whether the folder of the result is there.
std::atomic<bool> isOpen = false;

/// The first Ctrl-C ends the run with a checkpoint of its last step, a second one kills. Before there is
/// anything to keep, the first one ends the process.
void onInterrupt(int signal) {
  if (!isOpen) {
    constexpr std::string_view told = "mortier: interrupted before the first step; nothing was written\n";
    static_cast<void>(!write(STDERR_FILENO, told.data(), told.size()));
    _exit(exitFailed);
  }
  requestInterrupt();
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

/// \returns the exit code. \throws InputError, UnheldBodyError, OutputError, InterruptedError
int runScene(RunCommand command) {
  // 1. The scene, and the model it describes.
  for (const int signal : {SIGINT, SIGTERM, SIGHUP}) std::signal(signal, onInterrupt);
  std::optional<StoppedRun> stopped;
  if (!command.restart.empty()) {
    stopped = findStoppedRun(command.restart);
    if (!stopped) {
      warn(command.restart + ": the run was complete, its result is now in place");
      return exitDone;
    }
    if (command.scene.empty()) repeatRequest(stopped->checkpoint.identity, command);
    command.options.out = command.restart;
  }
  if (command.options.out.empty()) command.options.out = defaultFolder(command.scene);
  if (!command.options.factors.empty()) {
    DistributedEngine* engine = DistributedEngine::ofProgram();
    if (engine == nullptr)
      throw InputError("--factors: expected mortier-mpi, mortier keeps its factors in memory");
    engine->keepFactorsIn(command.options.factors);
  }
  ResolvedScene resolved = resolveScene(readScene(command.scene, command.settings));
  Faults doubts = lintResolved(resolved);
  Run run(std::move(resolved), command.options, std::move(stopped));
  const SceneDescription& scene = run.attempt()->scene();
  lintModel(scene, *run.attempt()->model, doubts);
  lintSettling(scene, run.settle(), doubts);

  // 2. Where the result goes, and what is reported.
  isOpen = true;
  run.open();
  warnOf(doubts);
  if (!command.restart.empty() && !run.resumes()) warn(command.restart + ": the rounds begin again");

  // 3. The march in time; where an accuracy is asked for, in rounds.
  run.solve();

  // 4. The result in place of an older one, and how well it holds.
  const Ending ending = run.finish();
  if (command.options.quiet && ending.code == exitDone)
    for (const std::string& warning : run.warnings()) warn(command.scene + ": " + warning);
  if (!ending.reason.empty()) complain(ending.reason);
  return ending.code;
}

/// Each stage goes on from the one before, in a result of its own; that of the last has the name of the run.
int runStages(const RunCommand& command) {
  const std::vector<std::string> stages =
      command.restart.empty() ? stagesToRun(command.scene, command.settings) : std::vector<std::string>();
  if (stages.empty()) return runScene(command);
  const std::string out = command.options.out.empty() ? defaultFolder(command.scene) : command.options.out;
  const auto settingsOf = [&](const std::string& stage) {
    std::vector<std::string> settings = command.settings;
    settings.push_back("stage=" + stage);
    return settings;
  };
  // What is wrong with a later stage is found before the first.
  for (const std::string& stage : stages) static_cast<void>(readScene(command.scene, settingsOf(stage)));
  std::string before;
  for (const std::string& stage : stages) {
    RunCommand each = command;
    each.options.out = stage == stages.back() ? out : out + "-" + stage;
    each.settings = settingsOf(stage);
    if (!before.empty()) each.settings.push_back("start=" + before);
    if (!command.options.quiet) std::printf("stage      %s\n", stage.c_str());
    if (const int code = runScene(each); code != exitDone) return code;
    before = each.options.out;
  }
  return exitDone;
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
  run->add_option("--factors", options.factors,
                  "folder in which mortier-mpi keeps its factors (default: memory)")
      ->check(CLI::ExistingDirectory)
      ->type_name("DIR");
  run->add_flag_callback(
      "--list-solutions", [=] { command->settings.emplace_back("solver.list_solutions=true"); },
      helpOf(keyAt("solver", "list_solutions")));
  run->add_flag("--quiet", options.quiet, "no log and no progress bar: messages on standard error alone");
  return {run, [command] {
            if (command->restart.empty() || !command->settings.empty()) command->requireScene();
            return runStages(*command);
          }};
}

}  // namespace mortier
