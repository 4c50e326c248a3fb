#include "commands/study.h"

#include <unistd.h>

#include <array>
#include <cstdlib>
#include <filesystem>
#include <vector>

#include "base/error.h"
#include "commands/shipped.h"

namespace mortier {

namespace {

/// Debian's Python has numpy, matplotlib and meshio; another one first in PATH may not.
std::string pythonProgram() {
  constexpr std::array candidates{"/usr/bin/python3", "/usr/local/bin/python3"};
  for (const char* candidate : candidates)
    if (access(candidate, X_OK) == 0) return candidate;
  return "python3";
}

}  // namespace

int study(const StudyCommand& command) {
  // 1. The program in study/, told where this one is.
  const auto folder = shippedFolder("study", "__main__.py");
  if (!folder)
    throw OutputError(
        command.study +
        ": the folder study/ of mortier (study/__main__.py) is found neither above the program nor in "
        "share/mortier");
  std::error_code ignored;
  const std::string self = std::filesystem::read_symlink("/proc/self/exe", ignored).string();
  if (!self.empty()) setenv("MORTIER", self.c_str(), 1);

  // 2. Its arguments.
  const std::string python = pythonProgram();
  std::vector<std::string> words{python, folder->string()};
  if (!command.out.empty()) words.insert(words.end(), {"--out", command.out});
  if (command.jobs > 0) words.insert(words.end(), {"--jobs", std::to_string(command.jobs)});
  if (command.quiet) words.emplace_back("--quiet");
  words.insert(words.end(), {"--", command.study});
  std::vector<char*> arguments;
  arguments.reserve(words.size() + 1);
  for (std::string& word : words) arguments.push_back(word.data());
  arguments.push_back(nullptr);

  // 3. This process becomes that one.
  execvp(python.c_str(), arguments.data());
  throw OutputError(python + ": cannot be run, expected Python 3 (Debian package python3)");
}

}  // namespace mortier
