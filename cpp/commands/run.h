#pragma once

#include <stdexcept>
#include <string>
#include <vector>

namespace mortier {

/// The user stopped the run.
class InterruptedError : public std::runtime_error {
 public:
  using std::runtime_error::runtime_error;
};

struct RunCommand {
  std::string scene;
  std::string out;                    ///< folder of the result; empty: out/<scene>
  std::vector<std::string> settings;  ///< key=value
  int threads = 1;
  bool quiet = false;
};

/// Solves a scene and writes its result. \returns the exit code.
/// \throws InputError, UnheldBodyError, OutputError
int run(const RunCommand& command);

}  // namespace mortier
