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
  std::string out;         ///< folder of the result; empty: out/<scene>
  std::string restart;     ///< folder of the result of a stopped run that goes on; empty: a new run
  double checkpoint = 30;  ///< wall time between checkpoints [s]; 0: one a step
  std::vector<std::string> settings;  ///< key=value
  int threads = 1;
  bool quiet = false;
};

/// Solves a scene and writes its result. \returns the exit code.
/// \throws InputError, UnheldBodyError, OutputError, InterruptedError
int run(RunCommand command);

}  // namespace mortier
