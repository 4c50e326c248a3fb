#include "commands/run.h"

#include <unistd.h>

#include <algorithm>
#include <csignal>
#include <cstdio>
#include <filesystem>
#include <memory>
#include <optional>

#include "adapt/error_history.h"
#include "adapt/rounds.h"
#include "base/error.h"
#include "base/interrupt.h"
#include "commands/complain.h"
#include "commands/exit_code.h"
#include "commands/solve.h"
#include "commands/version.h"
#include "linear/versions.h"
#include "lint/lint.h"
#include "mesh/medit.h"
#include "plan/estimate_doubts.h"
#include "plan/loads.h"
#include "report/clock.h"
#include "report/output_file.h"
#include "report/summary.h"
#include "scene/build.h"
#include "scene/build_quantities.h"
#include "scene/initial_equilibrium.h"
#include "scene/load_courses.h"
#include "scene/memory_need.h"
#include "scene/versions.h"

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

std::string joinedOnce(std::vector<std::string> words) {
  std::sort(words.begin(), words.end());
  words.erase(std::unique(words.begin(), words.end()), words.end());
  std::string text;
  for (const std::string& each : words) {
    text += (text.empty() ? "" : ", ") + each;
  }
  return text.empty() ? "none" : text;
}

RunFacts factsOf(const RunCommand& command, const SceneDescription& scene, std::vector<RoundFacts> rounds) {
  RunFacts facts;
  facts.rounds = std::move(rounds);
  facts.accuracy = scene.accuracy.energy;
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

/// Beside the times of the scene, what its steps need to know of its data where they are chosen by their
/// error.
void lookAhead(SceneDescription& scene, const Model& model) {
  if (!(scene.time.tolerance > 0)) return;
  LoadCourses loads = loadCourses(scene, model);
  scene.time.breaks = std::move(loads.breaks);
  scene.time.data = std::move(loads.data);
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
  log.print(logQuantities(facts.quantities, evaluate(facts.quantities, model, solved.state)));
}

int unknownsOf(const Model& model) {
  int unknowns = 0;
  for (const Body& body : model.bodies) unknowns += body.freeDofs();
  return unknowns;
}

size_t trianglesOf(const Model& model) {
  size_t triangles = 0;
  for (const Body& body : model.bodies) triangles += body.mesh().triangles.size();
  return triangles;
}

void clearFields(const std::string& folder, const std::map<std::string, FileRecord>& files) {
  std::error_code none;  // what stays is no part of the result
  for (const auto& [name, record] : files)
    if (std::filesystem::path(name).extension() == ".vtu")  // others are written anew
      std::filesystem::remove(std::filesystem::path(folder) / name, none);
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
  SceneDescription& scene = resolved.description;
  std::unique_ptr<Model> model;  // those who look at it know where it is
  RunFacts facts;
  const auto build = [&] {
    model = std::make_unique<Model>(buildModel(resolved));
    scene.solver.threads = command.threads;
    facts = factsOf(command, scene, std::move(facts.rounds));
    facts.sceneText = identity.text;
    facts.quantities = buildQuantities(scene, *model);
    lookAhead(scene, *model);
  };
  build();
  lintModel(scene, *model, doubts);
  addMeshes(*model, identity);
  if (stopped) {
    requireSame(stopped->checkpoint.identity, identity, stopped->folder);
    requireFits(stopped->checkpoint, *model, stopped->folder);
  }

  // 2. Where the result goes, and what is reported.
  const std::string path = command.out.empty() ? defaultFolder(command.scene) : command.out;
  std::optional<OutputFolder> folder;
  State state = initialState(*model);
  const bool goesOn = stopped && !rounds;
  if (!goesOn) lintSettling(scene, findInitialEquilibrium(scene, *model, state), doubts);
  for (const int signal : {SIGINT, SIGTERM, SIGHUP}) std::signal(signal, onInterrupt);
  if (stopped)
    folder.emplace(path, stopped->folder, std::move(stopped->lock));
  else
    folder.emplace(path);
  Checkpoints checkpoints(folder->temporary(), command.checkpoint, identity);
  Log log(command.quiet, scene.time.end);
  Log rows(command.quiet || rounds, scene.time.end);
  log.print("memory     " + aboutMemory(memoryNeed(*model)) + "\n");
  log.print(logHeader(facts, *model));
  log.print(rounds ? logRoundsHeader() : logStepsHeader());
  warnOf(doubts);
  if (stopped && rounds) warn(command.restart + ": the rounds begin again");

  // 3. The march in time; where an accuracy is asked for, again and again.
  Solved solved;
  Rounds::Verdict verdict = rounds ? Rounds::Verdict::goOn : Rounds::Verdict::reached;
  for (double begin = 0;;) {
    std::optional<ErrorHistory> errors;
    if (rounds) errors.emplace(*model);
    Solving solving{scene,       *model, facts, folder->temporary(), rows, std::move(state), {},
                    checkpoints, {},     {}};
    if (goesOn) solving.stopped = std::move(stopped->checkpoint);
    solving.onlyTheStart = rounds.has_value();
    solving.again = "; mortier run --restart " + path + (rounds ? " begins the rounds again" : " goes on");
    if (errors)
      solving.alsoObserve = [&](const State& at, const StepReport& report) { errors->add(at, report); };
    solved = solve(std::move(solving));
    if (!rounds || solved.report.status != Status::converged) break;
    const double now = processSeconds();
    const RoundResult result{errors->errors(), errors->energy(), solved.report.timeError, now - begin};
    verdict = rounds->judge(result, now);
    facts.rounds.push_back({trianglesOf(*model), unknownsOf(*model), solved.report.steps, rounds->meshError(),
                            solved.report.timeError, now - begin});
    log.print(logRound(facts.rounds));
    if (verdict != Rounds::Verdict::goOn) break;
    begin = now;
    clearFields(folder->temporary(), solved.files);
    errors.reset();
    resolved = rounds->scene();
    build();
    state = initialState(*model);
    findInitialEquilibrium(scene, *model, state);
  }

  // 4. The result, in place of an older one only when the run is complete.
  const bool complete = solved.report.status == Status::converged;
  const bool reached = verdict == Rounds::Verdict::reached;
  facts.doubts = estimateDoubts(scene, *model);
  Manifest manifest{!complete, std::move(solved.files)};
  if (rounds) {
    const std::vector<std::string> more = rounds->doubts();
    facts.doubts.insert(facts.doubts.end(), more.begin(), more.end());
    facts.reached = reached;
    for (const Body& body : model->bodies) {
      OutputFile file(folder->temporary() + "/" + body.name() + ".mesh");
      file << meditText(body.mesh());
      manifest.files[body.name() + ".mesh"] = file.close();
    }
  }
  manifest.files["summary.json"] = writeSummary(folder->temporary(), facts, *model, solved.state, solved.last,
                                                solved.report, solved.accuracy);
  const std::string where = folder->commit(manifest);

  // 5. How well it holds.
  tell(log, facts, *model, solved, where);
  if (!complete) {
    complain(scene.path + ": " + solved.report.reason + "; the state after step " +
             std::to_string(solved.last.step) + " is in " + where);
    return solved.report.status == Status::unheld ? exitUnheld : exitFailed;
  }
  if (reached) return exitDone;
  complain(scene.path + ": accuracy " + shortest(scene.accuracy.energy) +
           " not reached: " + rounds->reason() + "; the best result is in " + where);
  return exitFailed;
}

}  // namespace mortier
