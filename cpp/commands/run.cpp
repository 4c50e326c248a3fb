#include "commands/run.h"

#include <algorithm>
#include <csignal>
#include <cstdio>
#include <filesystem>

#include "base/error.h"
#include "commands/complain.h"
#include "commands/exit_code.h"
#include "report/contact_table.h"
#include "report/fields.h"
#include "report/history.h"
#include "report/log.h"
#include "report/output_folder.h"
#include "report/summary.h"
#include "scene/build.h"

namespace mortier {

namespace {

volatile std::sig_atomic_t interrupted = 0;

/// The first Ctrl-C ends the run after its step and takes the unfinished result away; a second one kills.
void onInterrupt(int signal) {
  interrupted = 1;
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
  facts.settings = command.settings;
  facts.scheme = word(scene.time.scheme);
  facts.plannedSteps = scene.time.steps;
  facts.threads = command.threads;
  std::vector<std::string> projections;
  for (const BodyDescription& body : scene.bodies) {
    const auto& flow = body.material.viscoplasticity;
    facts.materials.push_back(flow ? "Perzyna (" + word(flow->projection) + ")" : "elastic");
    if (flow) {
      projections.push_back(word(flow->projection));
    }
  }
  std::vector<std::string> nonmortars;
  for (const ContactDescription& contact : scene.contacts) {
    facts.variants.push_back(word(contact.variant));
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
  const double weight = scene.time.end / scene.time.steps / 2;
  double stiffness = 0;
  for (const Body& body : model.bodies) stiffness = std::max(stiffness, body.material().stiffness(weight));
  if (scene.time.scheme != Scheme::crankNicolson || stiffness <= ringing) return;
  char ratio[32];
  std::snprintf(ratio, sizeof ratio, "%.1e", 2 * stiffness);
  warn(scene.path + ": scheme = crank-nicolson rings here (step over relaxation time " + ratio +
       "); sdirk2 is of second order too and does not");
}

/// Whether a step is kept while the run goes on; the last one is kept in any case.
bool keeps(const SceneDescription& scene, int step) {
  return scene.every > 0 && step % scene.every == 0;
}

}  // namespace

int run(const RunCommand& command) {
  // 1. The scene, and the model it describes.
  SceneDescription scene = readScene(command.scene, command.settings);
  scene.solver.threads = command.threads;
  std::vector<std::string> warnings;
  const Model model = buildModel(scene, warnings);
  for (const std::string& warning : warnings) {
    warn(warning);
  }

  warnOfRinging(scene, model);

  // 2. Where the result goes, and what is reported.
  const std::string path = command.out.empty() ? defaultFolder(command.scene) : command.out;
  OutputFolder folder(path);
  History history(folder.temporary());
  ContactTable contact(folder.temporary(), model);
  Fields fields(folder.temporary(), model);
  const RunFacts facts = factsOf(command, scene);
  Log log(command.quiet, scene.time.end);
  log.print(logHeader(facts, model));

  // 3. The march in time. Whatever stops it leaves the last good step in `state`.
  std::signal(SIGINT, onInterrupt);
  std::signal(SIGTERM, onInterrupt);
  StepReport last;
  int lastKept = -1;
  const auto keep = [&](const State& state, int step) {
    fields.add(state, step);
    contact.add(state, step);
    lastKept = step;
  };
  const Observer observe = [&](const State& state, const StepReport& report) {
    if (interrupted != 0) {
      throw InterruptedError("interrupted at step " + std::to_string(report.step) + "; nothing was written");
    }
    if (report.step > 0) {
      history.add(report);
      log.step(report);
    }
    if (keeps(scene, report.step)) {
      keep(state, report.step);
    }
    last = report;
  };
  State state = initialState(model);
  const RunReport report = march(model, state, scene.time, scene.solver, observe);
  log.finish();

  // 4. The result, in place of an older one only when the run is complete.
  if (lastKept != last.step) {
    keep(state, last.step);
  }
  history.close();
  contact.close();
  fields.close();
  writeSummary(folder.temporary(), facts, model, state, last, report);
  const bool complete = report.status == Status::converged;
  std::string where = path;
  if (complete) {
    folder.commit();
  } else {
    where = folder.commitAsFailed();
  }

  // 5. How well it holds.
  log.print(logStatus(report, where));
  log.print(logVerification(report.worst));
  if (!complete) {
    complain(scene.path + ": " + report.reason + "; the state after step " + std::to_string(last.step) +
             " is in " + where);
  }
  return complete ? exitDone : report.status == Status::unheld ? exitUnheld : exitFailed;
}

}  // namespace mortier
