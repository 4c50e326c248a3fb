// The files that hold checkpoints of a run in its folder.
#pragma once

#include <filesystem>
#include <string>

namespace mortier {

constexpr const char* checkpointName = "checkpoint";
constexpr const char* previousCheckpointName = "checkpoint.previous";

inline bool isCheckpointFile(const std::string& name) {
  return name.compare(0, std::string(checkpointName).size(), checkpointName) == 0;
}

inline bool hasCheckpoint(const std::string& folder) {
  std::error_code none;
  return std::filesystem::exists(folder + "/" + checkpointName, none) ||
         std::filesystem::exists(folder + "/" + previousCheckpointName, none);
}

}  // namespace mortier
