#include "commands/study.h"

#include <vector>

#include "commands/python.h"

namespace mortier {

int study(const StudyCommand& command) {
  std::vector<std::string> words;
  if (!command.out.empty()) words.insert(words.end(), {"--out", command.out});
  if (command.jobs > 0) words.insert(words.end(), {"--jobs", std::to_string(command.jobs)});
  if (command.scheduler) words.insert(words.end(), {"--scheduler", *command.scheduler});
  if (command.quiet) words.emplace_back("--quiet");
  words.insert(words.end(), {"--", command.study});
  becomePython("study", words);
}

}  // namespace mortier
