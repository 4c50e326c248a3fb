#include "commands/views.h"

#include "commands/python.h"

namespace mortier {

namespace {

/// In one word, so that a value may begin with a minus.
void addOption(std::vector<std::string>& words, const std::string& name, const std::string& value) {
  if (!value.empty()) words.push_back("--" + name + '=' + value);
}

[[noreturn]] void becomeViews(std::vector<std::string> words, const std::vector<std::string>& results) {
  words.emplace_back("--");
  words.insert(words.end(), results.begin(), results.end());
  becomePython("views", words);
}

}  // namespace

int plot(const PlotCommand& command) {
  std::vector<std::string> words{"plot"};
  addOption(words, "out", command.out);
  addOption(words, "step", command.step);
  addOption(words, "field", command.field);
  addOption(words, "scale", command.scale);
  addOption(words, "window", command.window);
  addOption(words, "only", command.only);
  if (command.animate) words.emplace_back("--animate");
  if (command.raw) words.emplace_back("--raw");
  becomeViews(words, command.results);
}

int report(const ReportCommand& command) {
  std::vector<std::string> words{"report"};
  addOption(words, "out", command.out);
  becomeViews(words, command.results);
}

int compare(const CompareCommand& command) {
  std::vector<std::string> words{"compare"};
  for (const std::string& setting : command.settings) addOption(words, "set", setting);
  for (const std::string& place : command.against) addOption(words, "against", place);
  addOption(words, "accept", command.accept);
  addOption(words, "within", command.within);
  addOption(words, "picture", command.picture);
  becomeViews(words, {command.scene});
}

}  // namespace mortier
