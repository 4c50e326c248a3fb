// [[stage]]: parts of the loading, each a run that goes on from the one before. A stage is the scene with the
// settings of all stages up to it.
#include <algorithm>
#include <filesystem>
#include <string_view>

#include "base/error.h"
#include "scene/readers.h"

namespace mortier {
namespace {

constexpr std::string_view choice = "stage=";

struct LoadingStage {
  std::string name, where;
  std::vector<std::pair<std::string, std::string>> settings;  ///< key=value, and the place of each
};

/// As the document writes it, for a setting.
std::string valueOf(const Node& node) {
  return node.isString() ? node.text : node.quoted();
}

std::vector<LoadingStage> stagesIn(const Node& document) {
  std::vector<LoadingStage> stages;
  const Node* all = document.find("stage");
  for (size_t k = 0; all != nullptr && all->isArray() && k < all->elements.size(); ++k) {
    const TableReader table(all->elements[k], "stage", "stage " + std::to_string(k));
    LoadingStage stage{table.string("name"), all->elements[k].where, {}};
    if (!isName(stage.name)) table.reject("name", "letters, digits, _ and -");
    if (std::ranges::any_of(stages, [&](const LoadingStage& other) { return other.name == stage.name; }))
      table.reject("name", "a name of its own");
    for (const char* key : {"end", "steps"})
      if (const Node* node = table.find(key))
        stage.settings.emplace_back(std::string("time.") + key + "=" + valueOf(*node), node->where);
    for (const std::string& each : table.strings("set"))
      stage.settings.emplace_back(each, table.find("set")->where);
    stages.push_back(std::move(stage));
  }
  if (all != nullptr && stages.empty())
    throw InputError(all->where + ": stage: " + all->quoted() + ", expected tables [[stage]]");
  return stages;
}

std::string namesOf(const std::vector<LoadingStage>& stages) {
  Keys names;
  for (const LoadingStage& stage : stages) names.push_back(stage.name);
  return joined(names);
}

/// The last setting that chooses a stage; settings.end() where none does.
auto chosenBy(const std::vector<std::string>& settings) {
  const auto found = std::find_if(settings.rbegin(), settings.rend(),
                                  [](const std::string& each) { return each.starts_with(choice); });
  return found == settings.rend() ? settings.end() : std::prev(found.base());
}

}  // namespace

std::vector<std::string> stagesToRun(const std::string& path, const std::vector<std::string>& settings) {
  std::vector<std::string> names;
  std::error_code none;
  if (!std::filesystem::is_regular_file(path, none)) return names;  // what can be read once only
  if (chosenBy(settings) == settings.end())
    for (const LoadingStage& stage : stagesIn(readDocument(path, readSceneText(path))))
      names.push_back(stage.name);
  return names;
}

std::string applySettings(Node& document, const std::vector<std::string>& settings) {
  const auto isOfStages = [](const std::string& setting) { return setting.starts_with("stage."); };
  for (const std::string& setting : settings)
    if (isOfStages(setting)) applyOverride(document, setting, "");
  const std::vector<LoadingStage> stages = stagesIn(document);
  const auto chosen = chosenBy(settings);
  std::string before;
  if (!stages.empty()) {
    const std::string name = chosen == settings.end() ? "" : chosen->substr(choice.size());
    const auto found = std::ranges::find(stages, name, &LoadingStage::name);
    if (found == stages.end())
      throw InputError((name.empty() ? stages.front().where : "--set " + *chosen) +
                       ": stage: expected --set stage=NAME, one of " + namesOf(stages) +
                       "; mortier run without it takes them in turn");
    for (auto stage = stages.begin(); stage <= found; ++stage)
      for (const auto& [setting, where] : stage->settings)
        applyOverride(document, setting, where + ": set " + setting);
    if (found != stages.begin()) before = std::prev(found)->name;
    std::erase_if(document.members, [](const Node& member) { return member.key == "stage"; });
    if (std::next(found) != stages.end()) applyOverride(document, "output.state=true", found->where);
  } else if (chosen != settings.end()) {
    throw InputError("--set " + *chosen + ": the scene has no [[stage]]");
  }
  for (const std::string& setting : settings)
    if (!setting.starts_with(choice) && !isOfStages(setting)) applyOverride(document, setting, "");
  return before;
}

}  // namespace mortier
