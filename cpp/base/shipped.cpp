#include "base/shipped.h"

#include <unistd.h>

#include <array>

namespace mortier {

namespace fs = std::filesystem;

std::optional<fs::path> shippedFolder(const std::string& name, const std::string& file,
                                      const std::vector<fs::path>& starts) {
  std::error_code ignored;
  std::vector<fs::path> candidates;
  std::vector<fs::path> from = starts;
  from.push_back(fs::read_symlink("/proc/self/exe", ignored));
  for (const fs::path& start : from) {
    for (fs::path folder = start; !folder.empty(); folder = folder.parent_path()) {
      candidates.push_back(folder / name);
      candidates.push_back(folder / "share" / "mortier" / name);
      if (folder == folder.parent_path()) break;
    }
  }
#ifdef MORTIER_SOURCE
  candidates.push_back(fs::path(MORTIER_SOURCE) / name);
#endif
  for (const fs::path& folder : candidates)
    if (fs::exists(folder / file, ignored)) return folder;
  return std::nullopt;
}

/// Debian's Python has numpy, matplotlib and meshio; another one first in PATH may not.
std::string pythonProgram() {
  constexpr std::array candidates{"/usr/bin/python3", "/usr/local/bin/python3"};
  for (const char* candidate : candidates)
    if (access(candidate, X_OK) == 0) return candidate;
  return "python3";
}

}  // namespace mortier
