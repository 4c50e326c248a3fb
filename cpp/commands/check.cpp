// `mortier check`: prints what a run of the scene would model and leave out, and what is wrong or doubtful in
// it, without solving anything.
#include <CLI/CLI.hpp>
#include <algorithm>
#include <cstdio>
#include <memory>
#include <nlohmann/json.hpp>

#include "base/digits.h"
#include "base/printable.h"
#include "bound/energy_bound.h"
#include "commands/attempt.h"
#include "commands/command_line.h"
#include "commands/freefem.h"
#include "lint/lint.h"
#include "plan/plan.h"
#include "time/march.h"

namespace mortier {

namespace {

using Json = nlohmann::ordered_json;

void print(const Json& json) {
  std::puts(json.dump(2, ' ', false, Json::error_handler_t::replace).c_str());
}

int listKinds(bool json) {
  Json list = Json::array();
  for (const FaultKind& kind : faultKinds())
    list.push_back(
        {{"id", kind.id}, {"severity", word(kind.severity)}, {"what", kind.what}, {"remedy", kind.remedy}});
  if (json) {
    print(list);
    return exitDone;
  }
  for (const FaultKind& kind : faultKinds())
    std::printf("| `%s` | %s | %s | %s |\n", kind.id.c_str(), word(kind.severity).c_str(), kind.what.c_str(),
                kind.remedy.c_str());
  return exitDone;
}

/// Adds the items of a stage; "" where the scene has none.
void add(const std::string& stage, const Plan& plan, const Faults& faults, Json& json) {
  const auto put = [&](const char* list, Json item) {
    if (!stage.empty()) item["stage"] = stage;
    json[list].push_back(std::move(item));
  };
  for (const PlanItem& item : plan)
    put("plan", {{"part", item.part}, {"modelled", item.modelled}, {"what", item.what}, {"why", item.why}});
  for (const Fault& fault : faults.all())
    put("faults", {{"id", fault.kind->id},
                   {"severity", word(fault.kind->severity)},
                   {"place", printable(fault.place)},
                   {"message", printable(fault.message)},
                   {"remedy", fault.kind->remedy},
                   {"more", fault.more}});
}

/// What other commands and the bounds would refuse.
void addRefusals(const SceneDescription& scene, const Model& model, Plan& plan) {
  std::string why = freefemObstacle(scene, model, true);
  if (!why.empty())
    plan.push_back(
        {"freefem", false, "the scene in FreeFEM; mortier compare --against takes a kept result", why});
  else if (!(why = freefemObstacle(scene, model, false)).empty())
    plan.push_back({"freefem", false, "a script without the steps of a run", why});
  if (!scene.accuracy.bound) return;
  State end = initialState(model);
  end.time = scene.time.end;
  if (!(why = foreseenObstacle(model, end)).empty())
    plan.push_back({"accuracy", false, "a guaranteed bound of the error of the whole run's stress", why});
}

/// \param json  takes what is found, which is printed where it is null
/// \returns the exit code that a run would have, 0 where there are warnings only
int checkOne(const SceneOptions& command, const std::string& stage, Json* json) {
  LintReport report = lint(command.scene, command.settings);
  Plan plan;
  if (report.model) {
    if (const SceneDescription& scene = *report.scene; scene.after.empty() || !scene.start.empty()) try {
        static_cast<void>(startOf(*report.scene, *report.model));
      } catch (const InputError& error) {
        addError(error, "start", report.faults);
      }
    plan = planOf(*report.scene, *report.model);
    addRefusals(*report.scene, *report.model, plan);
  }
  const Faults& faults = report.faults;
  const int wrong = faults.count(Severity::error);
  const int unheld = faults.count(Severity::unheld);
  if (json != nullptr) {
    add(stage, plan, faults, *json);
  } else {
    if (!stage.empty()) std::printf("stage      %s\n", stage.c_str());
    std::fputs(planText(plan).c_str(), stdout);
    for (const Fault& fault : faults.all()) std::puts(printable(oneLine(fault)).c_str());
    std::printf("%s, %s\n", counted(wrong + unheld, "error").c_str(),
                counted(faults.count(Severity::warning), "warning").c_str());
  }
  return wrong > 0 ? exitWrongInput : unheld > 0 ? exitUnheld : exitDone;
}

/// The same of all stages: the code of the first that is wrong.
int checkStages(const SceneOptions& command, Json* json) {
  std::vector<std::string> stages;
  try {
    stages = stagesToRun(command.scene, command.settings);
  } catch (const InputError&) {
    return checkOne(command, "", json);  // which names it
  }
  if (stages.empty()) return checkOne(command, "", json);
  int result = exitDone;
  for (const std::string& stage : stages) {
    SceneOptions each = command;
    each.settings.push_back("stage=" + stage);
    if (const int code = checkOne(each, stage, json); result == exitDone) result = code;
  }
  return result;
}

int check(const SceneOptions& command, bool json) {
  if (!json) return checkStages(command, nullptr);
  Json report = {{"scene", command.scene}, {"plan", Json::array()}, {"faults", Json::array()}};
  const int result = checkStages(command, &report);
  print(report);
  return result;
}

}  // namespace

Command addCheck(CLI::App& app) {
  CLI::App* command = app.add_subcommand(
      "check", "check a scene without solving it: what a run models, errors, warnings (docs/check.md)");
  const auto scene = std::make_shared<SceneOptions>();
  scene->addScene(*command);
  scene->addSettings(*command);
  scene->addGoal(*command, "--accuracy", "energy", "E");
  const CLI::Option* json = command->add_flag("--json")->description("machine-readable");
  const CLI::Option* list =
      command->add_flag("--list")->description("all faults that it knows, and their remedies; no scene");
  return {command, [=]() -> int {
            if (list->count() > 0) return listKinds(json->count() > 0);
            scene->requireScene();
            return check(*scene, json->count() > 0);
          }};
}

}  // namespace mortier
