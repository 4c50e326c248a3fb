// The files that hold checkpoints of a run in its folder.
#pragma once

#include <filesystem>
#include <string>

namespace mortier {

constexpr const char* checkpointName = "checkpoint";
constexpr const char* previousCheckpointName = "checkpoint.previous";

/// \throws std::filesystem::filesystem_error  nobody can say.
inline bool hasCheckpoint(const std::string& folder) {
  return std::filesystem::is_regular_file(folder + "/" + checkpointName) ||
         std::filesystem::is_regular_file(folder + "/" + previousCheckpointName);
}

}  // namespace mortier
