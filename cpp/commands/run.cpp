#include "commands/run.h"

#include <unistd.h>

#include <atomic>
#include <csignal>
#include <cstdio>
#include <cstring>
#include <filesystem>
#include <memory>
#include <optional>

#include "adapt/rounds.h"
#include "base/error.h"
#include "base/interrupt.h"
#include "base/ranks.h"
#include "commands/attempt.h"
#include "commands/complain.h"
#include "commands/ending.h"
#include "commands/solve.h"
#include "commands/solve_rounds.h"
#include "lint/lint.h"
#include "scene/build.h"
#include "scene/memory_need.h"

namespace mortier {

namespace {

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
  return (std::filesystem::path("out") / std::filesystem::path(scene).stem()).string();
}

/// The warnings of `mortier check`, in its words.
void warnOf(const Faults& faults) {
  for (const Fault& fault : faults.all())
    if (fault.kind->severity == Severity::warning) warn(fault.place + ": " + withRemedy(fault));
}

/// How well it holds.
void tell(Log& log, const RunFacts& facts, const Model& model, const Solved& solved,
          const std::string& where) {
  log.print(logStatus(solved.report, where));
  log.print(logVerification(solved.report.worst));
  log.print(logSpecial(solved.report.special));
  log.print(logAccuracy(facts, model, solved.accuracy));
  log.print(logTimeError(facts, solved.report));
  log.print(logPeaks(solved.report.peaks, solved.last, facts.units, !model.interfaces.empty()));
  log.print(logQuantities(facts, model, solved.state, solved.accuracy.bound));
  log.print(logRanges(facts, solved.report.quantities));
}

}  // namespace

int run(RunCommand command) {
  // 1. The scene, and the model it describes.
  Ranks& ranks = Ranks::all();
  std::optional<StoppedRun> stopped;
  if (!command.restart.empty()) {
    if (ranks.first()) stopped = findStoppedRun(command.restart);
    const std::string left = textOfFirst(ranks, stopped ? stopped->folder : "");
    if (!ranks.first() && !left.empty()) stopped = StoppedRun{left, {}, readCheckpoint(left)};
    if (!stopped) {
      warn(command.restart + ": the run was complete, its result is now in place");
      return exitDone;
    }
    if (command.scene.empty()) askAgain(stopped->checkpoint.identity, command);
    command.out = command.restart;
  }
  ResolvedScene resolved = resolveScene(readScene(command.scene, command.settings));
  Faults doubts = lintResolved(resolved);
  std::optional<Rounds> rounds = beginRounds(resolved);
  const AttemptOptions options{command.threads, ranks.shared()};
  auto attempt = std::make_unique<Attempt>(std::move(resolved), options);
  std::optional<FirstRankOnly> alone;
  if (!attempt->alone.empty()) {
    if (!ranks.first()) return exitDone;  // it waits for the first
    alone.emplace();
  }
  RunIdentity identity;
  if (ranks.first()) {
    lintModel(attempt->resolved.description, *attempt->model, doubts);
    identity = identityOf(attempt->resolved.description, *attempt->model);
  }
  if (stopped && ranks.first()) {
    requireSame(stopped->checkpoint.identity, identity, stopped->folder);
    requireFits(stopped->checkpoint, *attempt->model, stopped->folder, attempt->facts.quantities.size());
  }

  // 2. Where the result goes, and what is reported.
  const std::string path = command.out.empty() ? defaultFolder(command.scene) : command.out;
  std::optional<OutputFolder> folder;
  const bool goesOn = stopped && !rounds;
  if (!goesOn) {
    const SceneDescription& scene = attempt->resolved.description;
    lintSettling(scene, findInitialEquilibrium(scene, attempt->solvedModel(), attempt->state), doubts);
  }
  atOnce = "mortier: interrupted before the first step; nothing was written\n";
  for (const int signal : {SIGINT, SIGTERM, SIGHUP}) std::signal(signal, onInterrupt);
  if (stopped && ranks.first())
    folder.emplace(path, stopped->folder, std::move(stopped->lock));
  else if (ranks.first())
    folder.emplace(path);
  const std::string temporary = folder ? folder->temporary() : "";
  Checkpoints checkpoints(temporary, command.checkpoint, identity);
  const double endTime = attempt->resolved.description.time.end;
  Log log(command.quiet, endTime);
  Log rows(command.quiet || rounds, endTime);
  const MemoryNeed need = memoryNeed(*attempt->model, attempt->resolved.description.solver);
  const std::string part = anyFriction(*attempt->model) ? forFriction(need) : "";
  log.print("memory     " + aboutMemory(need.all) + (part.empty() ? "" : ", " + part) +
            (rounds ? ", first meshes\n" : "\n"));
  if (alone) log.print("ranks      the first one alone: " + attempt->alone + "\n");
  log.print(logHeader(attempt->facts, *attempt->model));
  log.print(rounds ? logRoundsHeader() : logStepsHeader(attempt->facts.units));
  warnOf(doubts);
  if (stopped && rounds) warn(command.restart + ": the rounds begin again");

  // 3. The march in time; where an accuracy is asked for, again and again.
  const std::string again =
      "; mortier run --restart " + path + (rounds ? " begins the rounds again" : " goes on");
  static std::string betweenRounds;
  betweenRounds = "mortier: " + command.scene + ": interrupted between rounds" + again + "\n";
  const auto solveIt = [&](Attempt& now, Observer alsoObserve) {
    Solving solving{now.resolved.description,
                    *now.model,
                    now.solvedModel(),
                    *now.error,
                    now.facts,
                    temporary,
                    rows,
                    now.state,
                    {},
                    checkpoints,
                    {},
                    std::move(alsoObserve)};
    if (goesOn) solving.stopped = std::move(stopped->checkpoint);
    solving.checkpointInitialStateOnly = rounds.has_value();
    solving.again = again;
    now.solved = solve(std::move(solving));
    if (rounds) atOnce = betweenRounds.c_str();
  };
  std::string shortfall;  // why the accuracy is not reached
  if (rounds) {
    try {
      shortfall = solveRounds(*rounds, attempt, options, temporary, log, solveIt);
    } catch (const Interrupted&) {
      throw InterruptedError(command.scene + ": interrupted between rounds" + again);
    }
  } else {
    solveIt(*attempt, {});
    shortfall = attempt->solved.report.shortfall;
  }

  if (!ranks.first()) return endingOf(*attempt, shortfall, "").code;

  // 4. The result, in place of an older one only when the run is complete.
  addVerdict(*attempt, rounds ? &*rounds : nullptr, shortfall);
  const std::string where = putInPlace(*attempt, *folder);

  // 5. How well it holds.
  tell(log, attempt->facts, *attempt->model, attempt->solved, where);
  const Ending ending = endingOf(*attempt, shortfall, where);
  if (ending.code != exitDone) complain(ending.reason);
  return ending.code;
}

}  // namespace mortier
