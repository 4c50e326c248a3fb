#pragma once

#include <string>
#include <vector>

namespace mortier {

struct CheckCommand {
  std::string scene;
  std::vector<std::string> settings;  ///< key=value
  bool json = false;
  bool list = false;  ///< the kinds of faults, no scene
};

/// Prints what a run of the scene would model and leave out, and what is wrong or doubtful in it, without
/// solving anything. \returns the exit code that a run would have, 0 where there are warnings only.
int check(const CheckCommand& command);

}  // namespace mortier
