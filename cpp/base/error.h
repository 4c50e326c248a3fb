#pragma once

#include <stdexcept>
#include <string>
#include <utility>

namespace mortier {

/// A wrong input: scene, mesh, number or file. The message is one line that names the place, the value and
/// what was expected, e.g. `compression.toml:14: body upper: poisson = 0.6, expected -1 < poisson < 0.5`.
/// Exit code 2.
class InputError : public std::runtime_error {
 public:
  explicit InputError(const std::string& message, std::string fault = "")
      : std::runtime_error(message), fault_(std::move(fault)) {}
  /// Its id in docs/check.md; empty where it has none of its own.
  [[nodiscard]] const std::string& fault() const { return fault_; }

 private:
  std::string fault_;
};

/// A scene that has no (unique) solution: a body that nothing holds. The message names the free motion. Exit
/// code 3.
class UnheldBodyError : public std::runtime_error {
 public:
  using std::runtime_error::runtime_error;
};

/// A file that cannot be written. Exit code 1.
class OutputError : public std::runtime_error {
 public:
  using std::runtime_error::runtime_error;
};

/// A datum that is not finite somewhere at some time: wrong input (exit code 2). In a run that has begun it
/// ends the step, and the last good state is kept (exit code 1).
class DatumError : public InputError {
 public:
  using InputError::InputError;
};

}  // namespace mortier
