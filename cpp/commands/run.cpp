#include "commands/run.h"

#include <unistd.h>

#include <csignal>
#include <cstdio>
#include <filesystem>
#include <memory>
#include <optional>

#include "adapt/rounds.h"
#include "base/error.h"
#include "base/interrupt.h"
#include "commands/attempt.h"
#include "commands/complain.h"
#include "commands/exit_code.h"
#include "commands/solve.h"
#include "commands/solve_rounds.h"
#include "lint/lint.h"
#include "mesh/medit.h"
#include "plan/estimate_doubts.h"
#include "report/output_file.h"
#include "report/summary.h"
#include "scene/initial_equilibrium.h"
#include "scene/memory_need.h"

namespace mortier {

namespace {

/// The first Ctrl-C ends the run with a checkpoint of its last step; a second one kills, and so does the
/// first where a library would not hear of it (before the first step).
void onInterrupt(int signal) {
  if (inDeafCall()) {
    constexpr char text[] = "mortier: interrupted before the first step; nothing was written\n";
    static_cast<void>(!write(STDERR_FILENO, text, sizeof text - 1));
    _exit(exitFailed);
  }
  requestInterrupt();
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
  log.print(logPeaks(solved.report.peaks, solved.last));
  log.print(logQuantities(facts.quantities, evaluate(facts.quantities, model, solved.state),
                          solved.accuracy.bound));
}

/// What a bound needs to know of a quantity.
Functional functionalOf(const Quantity& quantity, bool atPoint) {
  using Kind = Functional::Kind;
  Functional result{quantity.kind == Quantity::Kind::reaction       ? Kind::reaction
                    : quantity.kind == Quantity::Kind::contactForce ? Kind::contactForce
                                                                    : Kind::displacement,
                    quantity.body, quantity.label};
  if (quantity.component == Quantity::Component::moment) {
    result.turn = 1;
    result.about = quantity.about;
  } else {
    result.direction = Point::Unit(quantity.component == Quantity::Component::x ? 0 : 1);
  }
  if (atPoint) result.obstacle = "displacements at a point have none, means of a label have";
  return result;
}

/// A bound of the error; what stops it does not take the result away.
EnergyBound boundOf(const Model& model, const State& state, const std::vector<Functional>& functionals) {
  const KeepsResult keeps;
  EnergyBound none;
  try {
    return energyBound(model, state, functionals);
  } catch (const Interrupted&) {
    none.obstacle = "interrupted";
  } catch (const std::bad_alloc&) {
    none.obstacle = "there is no memory for it";
  }
  return none;
}

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
  std::optional<Rounds> rounds;
  if (resolved.description.accuracy.energy > 0) {
    rounds.emplace(std::move(resolved));
    resolved = rounds->scene();
  }
  const AttemptOptions options{command.settings, command.threads, identity.text};
  auto attempt = std::make_unique<Attempt>(std::move(resolved), options);
  lintModel(attempt->resolved.description, *attempt->model, doubts);
  addMeshes(*attempt->model, identity);
  if (stopped) {
    requireSame(stopped->checkpoint.identity, identity, stopped->folder);
    requireFits(stopped->checkpoint, *attempt->model, stopped->folder);
  }

  // 2. Where the result goes, and what is reported.
  const std::string path = command.out.empty() ? defaultFolder(command.scene) : command.out;
  std::optional<OutputFolder> folder;
  const bool goesOn = stopped && !rounds;
  if (!goesOn) {
    const SceneDescription& scene = attempt->resolved.description;
    lintSettling(scene, findInitialEquilibrium(scene, *attempt->model, attempt->state), doubts);
  }
  for (const int signal : {SIGINT, SIGTERM, SIGHUP}) std::signal(signal, onInterrupt);
  if (stopped)
    folder.emplace(path, stopped->folder, std::move(stopped->lock));
  else
    folder.emplace(path);
  Checkpoints checkpoints(folder->temporary(), command.checkpoint, identity);
  const double endTime = attempt->resolved.description.time.end;
  Log log(command.quiet, endTime);
  Log rows(command.quiet || rounds, endTime);
  log.print("memory     " + aboutMemory(memoryNeed(*attempt->model)) + "\n");
  log.print(logHeader(attempt->facts, *attempt->model));
  log.print(rounds ? logRoundsHeader() : logStepsHeader());
  warnOf(doubts);
  if (stopped && rounds) warn(command.restart + ": the rounds begin again");

  // 3. The march in time; where an accuracy is asked for, again and again.
  const auto solveIt = [&](Attempt& now, Observer alsoObserve) {
    Solving solving{now.resolved.description,
                    *now.model,
                    now.facts,
                    folder->temporary(),
                    rows,
                    now.state,
                    {},
                    checkpoints,
                    {},
                    std::move(alsoObserve)};
    if (goesOn) solving.stopped = std::move(stopped->checkpoint);
    solving.onlyTheStart = rounds.has_value();
    solving.again = "; mortier run --restart " + path + (rounds ? " begins the rounds again" : " goes on");
    now.solved = solve(std::move(solving));
  };
  std::string shortfall;  // why the accuracy is not reached
  if (rounds)
    shortfall = solveRounds(*rounds, attempt, options, folder->temporary(), log, solveIt);
  else
    solveIt(*attempt, {});

  // 4. The result, in place of an older one only when the run is complete.
  const SceneDescription& scene = attempt->resolved.description;
  Solved& solved = attempt->solved;
  RunFacts& facts = attempt->facts;
  const bool complete = solved.report.status == Status::converged;
  facts.doubts = estimateDoubts(scene, *attempt->model);
  if (complete && scene.accuracy.bound) {
    std::vector<Functional> functionals;
    for (size_t i = 0; i < facts.quantities.size(); ++i)
      functionals.push_back(functionalOf(facts.quantities[i], scene.quantities[i].point.has_value()));
    solved.accuracy.bound = boundOf(*attempt->model, solved.state, functionals);
  }
  Manifest manifest{!complete, std::move(solved.files)};
  if (rounds) {
    const std::vector<std::string> more = rounds->doubts();
    facts.doubts.insert(facts.doubts.end(), more.begin(), more.end());
    facts.reached = complete && shortfall.empty();
    for (const Body& body : attempt->model->bodies) {
      OutputFile file(folder->temporary() + "/" + body.name() + ".mesh");
      file << meditText(body.mesh());
      manifest.files[body.name() + ".mesh"] = file.close();
    }
  }
  manifest.files["summary.json"] = writeSummary(folder->temporary(), facts, *attempt->model, solved.state,
                                                solved.last, solved.report, solved.accuracy);
  const std::string where = folder->commit(manifest);

  // 5. How well it holds.
  tell(log, facts, *attempt->model, solved, where);
  if (!complete) {
    complain(scene.path + ": " + solved.report.reason + "; the state after step " +
             std::to_string(solved.last.step) + " is in " + where);
    return solved.report.status == Status::unheld ? exitUnheld : exitFailed;
  }
  if (shortfall.empty()) return exitDone;
  complain(scene.path + ": accuracy " + shortest(scene.accuracy.energy) + " not reached: " + shortfall +
           "; the best result is in " + where);
  return exitFailed;
}

}  // namespace mortier
