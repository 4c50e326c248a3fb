#include "commands/ending.h"

#include <cstdio>

#include "commands/bound_of.h"
#include "mesh/medit.h"
#include "plan/estimate_doubts.h"
#include "plan/loads.h"
#include "report/output_file.h"
#include "report/summary.h"
#include "scene/document.h"

namespace mortier {

namespace {

/// The law of a triangle.
std::string lawOf(const BodyDescription& description, const Body& body, int triangle) {
  size_t part = 0;  // of the body's laws; the first is that of the triangles in no region with its own
  size_t next = 0;
  for (const RegionDescription& region : description.regions)
    if (region.material && (++next, region.label == body.mesh().regions[triangle])) part = next;
  const std::vector<LawDescription> laws = body.material().laws();
  return laws[part].text();
}

/// "; furthest off ..." where that is known.
std::string whereToLook(const Attempt& attempt) {
  const std::optional<StuckPlace>& stuck = attempt.solved.report.stuck;
  if (!stuck) return "";
  const Body& body = attempt.model->bodies[stuck->body];
  const std::string& driving = attempt.facts.driving;
  char at[64];
  std::snprintf(at, sizeof at, "(%.4g, %.4g)", stuck->at.x(), stuck->at.y());
  return "; furthest off its law, " + lawOf(attempt.scene().bodies[stuck->body], body, stuck->triangle) +
         ", is body " + body.name() + " at " + at + ", triangle " + std::to_string(stuck->triangle) +
         (driving.empty() ? "" : "; what drives the step is " + driving);
}

}  // namespace

void addVerdict(Attempt& attempt, const Rounds* rounds, const std::string& shortfall) {
  RunFacts& facts = attempt.facts;
  Solved& solved = attempt.solved;
  const bool complete = solved.report.status == Status::converged;
  if (solved.report.stuck) {
    MeshedScene meshed{attempt.scene(), {}};
    for (const Body& body : attempt.model->bodies) meshed.meshes.push_back(&body.mesh());
    facts.driving = drivingDatum(meshed, solved.state.time, solved.report.stuck->time);
  }
  facts.doubts = estimateDoubts(attempt.scene(), *attempt.model);
  for (const std::string& doubt : pointForceDoubts(*attempt.model, solved.state))
    facts.doubts.push_back(doubt);
  if (complete && attempt.scene().accuracy.bound && !solved.accuracy.bound)
    solved.accuracy.bound = boundOf(attempt);
  if (complete && solved.accuracy.flow) solved.accuracy.step = stepBoundOf(attempt);
  if (rounds == nullptr) return;
  const std::vector<std::string> more = rounds->doubts();
  facts.doubts.insert(facts.doubts.end(), more.begin(), more.end());
  facts.reached = complete && shortfall.empty();
}

std::string putInPlace(const Attempt& attempt, OutputFolder& folder) {
  const Solved& solved = attempt.solved;
  const std::string& path = folder.temporary();
  Manifest manifest{solved.report.status != Status::converged, solved.files};
  if (attempt.scene().accuracy.asked() > 0)
    for (const Body& body : attempt.model->bodies) {
      OutputFile file(path + "/" + body.name() + ".mesh");
      file << meditText(body.mesh());
      manifest.files[body.name() + ".mesh"] = file.close();
    }
  manifest.files["summary.json"] = writeSummary(path, attempt.facts, *attempt.model, solved.state,
                                                solved.last, solved.report, solved.accuracy);
  return folder.commit(manifest);
}

Ending endingOf(const Attempt& attempt, const std::string& shortfall, const std::string& folder) {
  const SceneDescription& scene = attempt.scene();
  const RunReport& report = attempt.solved.report;
  if (report.status != Status::converged)
    return {report.status == Status::unheld ? exitUnheld : exitFailed,
            scene.path + ": " + report.reason + whereToLook(attempt) + "; the state after step " +
                std::to_string(attempt.solved.last.step) + " is in " +
                (folder.empty() ? "memory" : folder + ", which mortier plot draws")};
  if (shortfall.empty()) return {};
  const AccuracyGoal& goal = scene.accuracy;
  const bool inRounds = goal.asked() > 0;
  return {exitFailed, scene.path + ": " +
                          (inRounds ? "accuracy " + shortest(goal.asked())
                                    : "time.tolerance " + shortest(scene.time.tolerance)) +
                          (goal.quantity.empty() ? "" : " of " + goal.quantity) +
                          " not reached: " + shortfall + "; the " + (inRounds ? "best" : "last") +
                          " result is in " + (folder.empty() ? "memory" : folder)};
}

}  // namespace mortier
