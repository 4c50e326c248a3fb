#include "commands/run.h"

#include <algorithm>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <utility>

#include "base/checksum.h"
#include "base/error.h"
#include "base/interrupt.h"
#include "linear/distributed_engine.h"
#include "mesh/read.h"
#include "plan/estimate_doubts.h"
#include "plan/loads.h"
#include "report/clock.h"
#include "report/log.h"
#include "report/manifest.h"
#include "report/stored_state.h"
#include "scene/build.h"
#include "scene/document.h"
#include "scene/memory_need.h"

namespace mortier {

namespace fs = std::filesystem;

namespace {

/// With the hashes of meshes and of files of temperatures.
RunIdentity identityOf(const SceneDescription& scene, const Model& model) {
  RunIdentity identity;
  identity.workingFolder = fs::current_path().string();
  identity.scene = scene.path;
  identity.settings = scene.settings;
  identity.text = scene.text;
  for (const Body& body : model.bodies) {
    body.withMesh([&](const auto& mesh, const auto&) {
      identity.files.push_back("the mesh " + mesh.name);
      identity.fileHashes.push_back(hashOf(mesh));
    });
  }
  const auto add = [&](const std::string& path) {
    std::ifstream file(path, std::ios::binary);
    Checksum checksum;
    checksum.add(std::string(std::istreambuf_iterator<char>(file), {}));
    identity.files.push_back("the file " + path);
    identity.fileHashes.push_back(checksum.value);
  };
  for (const BodyDescription& body : scene.bodies)
    if (body.temperature && !body.temperature->file.empty()) add(body.temperature->file);
  if (!scene.start.empty()) add(scene.start + "/" + stateName);
  return identity;
}

/// The law of a triangle or a tetrahedron.
std::string lawOf(const BodyDescription& description, const Body& body, int triangle) {
  size_t index = 0;  // of the body's laws; the first is that of the triangles in regions without a law
  size_t next = 0;
  for (const RegionDescription& region : description.regions)
    if (region.material && (++next, region.label == body.regions()[triangle])) index = next;
  const std::vector<LawDescription> laws = body.material().laws();
  return laws[index].text();
}

/// "; largest residual ..." where that is known.
std::string whereToLook(const Attempt& attempt) {
  const std::optional<StuckPlace>& stuck = attempt.solved.report.stuck;
  if (!stuck) return "";
  const Body& body = attempt.model->bodies[stuck->body];
  const std::string& driving = attempt.facts.driving;
  const bool space = body.dimension() == 3;
  return "; largest residual of the law, " +
         lawOf(attempt.scene().bodies[stuck->body], body, stuck->triangle) + ": body " + body.name() +
         " at " + placeText(stuck->at, body.dimension()) + (space ? ", tetrahedron " : ", triangle ") +
         std::to_string(stuck->triangle) + (driving.empty() ? "" : "; loading: " + driving);
}

/// The rounds of a scene with an accuracy.
std::optional<Rounds> roundsOf(const ResolvedScene& scene) {
  if (!(scene.description.accuracy.asked() > 0)) return std::nullopt;
  return Rounds(scene);
}

}  // namespace

std::optional<StoppedRun> findStoppedRun(const std::string& path) {
  try {
    const ResultPlace place(path);
    const PlaceLock lockOfPlace(place.parent().string());
    const ResultPlace::LeftBehind left = place.clearUp();
    if (!left.stopped.empty()) {
      const std::string folder = left.stopped.front().string();
      FolderLock lock(folder);
      if (!lock.held()) throw OutputError(place.shown(folder) + ": cannot be locked");
      return StoppedRun{folder, std::move(lock), readCheckpoint(folder)};
    }
    if (left.placed == place.of(true))
      throw OutputError(place.shown(left.placed) + ": the run had stopped at a step that cannot be solved");
    if (!left.placed.empty()) return {};
  } catch (const fs::filesystem_error& error) {
    throw OutputError(path + ": " + error.code().message());
  }
  throw InputError(path + ": no stopped run, expected a folder " + path + ".tmp-... with a checkpoint in it");
}

Run::Run(ResolvedScene scene, RunOptions options, std::optional<StoppedRun> stopped)
    : options_(std::move(options)),
      stopped_(std::move(stopped)),
      rounds_(roundsOf(scene)),
      attempt_(std::make_shared<Attempt>(rounds_ ? rounds_->scene() : std::move(scene), options_.threads)),
      log_(options_.quiet, attempt_->scene().time.end),
      rows_(options_.quiet || rounds_, attempt_->scene().time.end) {
  if (options_.out.empty()) return;
  identity_ = identityOf(attempt_->scene(), *attempt_->model);
  if (!stopped_) return;
  requireSame(stopped_->checkpoint.identity, identity_, stopped_->folder);
  requireFits(stopped_->checkpoint, *attempt_->model, stopped_->folder, attempt_->facts.quantities.size());
}

std::string Run::settle() const {
  if (resumes()) return "";
  return findInitialEquilibrium(attempt_->scene(), *attempt_->model, attempt_->solved.state);
}

void Run::open() {
  const Attempt& first = *attempt_;
  if (!options_.out.empty()) {
    if (stopped_)
      folder_.emplace(options_.out, stopped_->folder, std::move(stopped_->lock));
    else
      folder_.emplace(options_.out);
    temporary_ = folder_->temporary();
  }
  resumeHint_ =
      "; mortier run --restart " + options_.out + (rounds_ ? " begins the rounds again" : " goes on");
  lastCheckpoint_ = processSeconds();
  if (options_.quiet) return;
  const MemoryNeed need = memoryNeed(*first.model, first.scene().solver);
  const std::string friction = anyFriction(*first.model) ? forFriction(need) : "";
  const bool single =
      std::any_of(first.model->bodies.begin(), first.model->bodies.end(), [&](const Body& body) {
        return engineOf(*first.model, body, first.scene().solver) == LinearEngine::single;
      });
  log_.print("memory     " + aboutMemory(need.all) + (friction.empty() ? "" : ", " + friction) +
             (single ? ", factors in single precision, corrected" : "") +
             (rounds_ ? ", first meshes\n" : "\n"));
  if (const DistributedEngine* engine = DistributedEngine::ofProgram())
    log_.print("factors    by MUMPS " + engine->version() + " in " + std::to_string(engine->processes()) +
               " processes" + (options_.factors.empty() ? "" : ", kept in " + options_.factors) + "\n");
  log_.print(logHeader(first.facts, *first.model));
  log_.print(rounds_ ? logRoundsHeader(*first.model) : logStepsHeader(first.facts.units));
}

void Run::solve(Observe observe) {
  observe_ = std::move(observe);
  if (!rounds_) {
    march(attempt_);
    shortfall_ = attempt_->solved.report.shortfall;
    return;
  }
  try {
    solveRounds();
  } catch (const Interrupted&) {
    throw InterruptedError(attempt_->scene().path + ": interrupted between rounds" +
                           (temporary_.empty() ? "" : resumeHint_));
  }
}

/// Adds what spoils the estimates, whether the run has the accuracy that was asked for, and bounds.
void Run::addVerdict() {
  RunFacts& facts = attempt_->facts;
  Solved& solved = attempt_->solved;
  const bool complete = solved.report.status == Status::converged;
  if (solved.report.stuck)
    facts.driving = drivingDatum(meshedScene(attempt_->scene(), *attempt_->model), solved.state.time,
                                 solved.report.stuck->time);
  if (!attempt_->scene().inSpace()) facts.doubts = estimateDoubts(attempt_->scene(), *attempt_->model);
  for (const std::string& doubt : pointForceDoubts(*attempt_->model, solved.state))
    facts.doubts.push_back(doubt);
  for (const ContactDoubt& doubt :
       contactDoubts(*attempt_->model, solved.state, solved.report.peaks.contactForce.value)) {
    facts.doubts.push_back(doubt.text);
    for (size_t i = 0; i < solved.accuracy.quantities.size() && i < solved.last.quantities.size(); ++i)
      if (leavesUnknown(doubt, facts.quantities[i], attempt_->scene().quantities[i].part.has_value(),
                        *attempt_->model))
        withdraw(solved.accuracy.quantities[i], solved.last.quantities[i], "contact there is not resolved");
  }
  if (const RunReport& report = solved.report;
      report.peaks.contactForce.value == 0 && !report.overlap.explained)
    facts.doubts.push_back(report.overlap.words);
  if (complete && attempt_->scene().accuracy.bound && !solved.accuracy.bound)
    solved.accuracy.bound = boundOf(*attempt_);
  if (!rounds_) return;
  for (const std::string& doubt : rounds_->doubts()) facts.doubts.push_back(doubt);
  facts.reached = complete && shortfall_.empty();
}

/// Writes the summary, beside an accuracy the meshes, and puts the result in place of an older one.
void Run::putInPlace() {
  const Solved& solved = attempt_->solved;
  Manifest manifest{solved.report.status != Status::converged, solved.files};
  const auto write = [&](const std::string& name, const std::string& text) {
    manifest.files[name] = (OutputFile(temporary_ + "/" + name) << text).close();
  };
  if (rounds_)
    for (const Body& body : attempt_->model->bodies)
      write(body.name() + ".mesh",
            body.withMesh([](const auto& mesh, const auto&) { return meditText(mesh); }));
  if (attempt_->scene().keepsState)
    write(stateName, stateText(*attempt_->model, solved.state, attempt_->facts.units, attempt_->facts.plane));
  write("summary.json", summary_);
  placed_ = folder_->commit(manifest);
}

Ending Run::ending() const {
  const SceneDescription& scene = attempt_->scene();
  const RunReport& report = attempt_->solved.report;
  if (report.status != Status::converged)
    return {report.status == Status::unheld ? exitUnheld : exitFailed,
            scene.path + ": " + report.reason + whereToLook(*attempt_) + "; the state after step " +
                std::to_string(attempt_->solved.last.step) + " is in " +
                (placed_.empty() ? "memory" : placed_ + ", which mortier plot draws")};
  if (shortfall_.empty()) return {};
  const AccuracyGoal& goal = scene.accuracy;
  return {exitFailed, scene.path + ": " +
                          (rounds_ ? "accuracy " + shortest(goal.asked())
                                   : "time.tolerance " + shortest(scene.time.tolerance)) +
                          (goal.quantity.empty() ? "" : " of " + goal.quantity) +
                          " not reached: " + shortfall_ + "; the " + (rounds_ ? "best" : "last") +
                          " result is in " + (placed_.empty() ? "memory" : placed_)};
}

std::vector<std::string> Run::warnings() const {
  return warningsOf(attempt_->solved.report, *attempt_->model, attempt_->facts.units);
}

Ending Run::finish() {
  addVerdict();
  summary_ = summaryText(folder_ ? temporary_ + "/summary.json" : "summary", attempt_->facts,
                         *attempt_->model, attempt_->solved);
  if (folder_) putInPlace();
  log_.print(logEnd(attempt_->facts, *attempt_->model, attempt_->solved, placed_));
  return ending();
}

}  // namespace mortier
