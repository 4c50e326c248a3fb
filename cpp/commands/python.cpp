#include "commands/python.h"

#include <unistd.h>

#include <array>
#include <cstdlib>
#include <filesystem>

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

void becomePython(const std::string& folder, const std::vector<std::string>& words) {
  const auto program = shippedFolder(folder, "__main__.py");
  if (!program) {
    throw OutputError("the folder " + folder + "/ of mortier (" + folder +
                      "/__main__.py) is found neither above the program nor in share/mortier");
  }
  std::error_code ignored;
  const std::string self = std::filesystem::read_symlink("/proc/self/exe", ignored).string();
  if (!self.empty()) setenv("MORTIER", self.c_str(), 1);

  std::string python = pythonProgram();
  std::vector<std::string> all{python, program->string()};
  all.insert(all.end(), words.begin(), words.end());
  std::vector<char*> arguments;
  arguments.reserve(all.size() + 1);
  for (std::string& word : all) arguments.push_back(word.data());
  arguments.push_back(nullptr);
  execvp(python.c_str(), arguments.data());
  throw OutputError(python + ": cannot be run, expected Python 3 (Debian package python3)");
}

}  // namespace mortier
