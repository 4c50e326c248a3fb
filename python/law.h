// What a callable of Python raises while a run without the interpreter lock goes on.
#pragma once

#include <pybind11/pybind11.h>

#include <memory>
#include <stdexcept>

namespace mortier::python {

/// Ends the run; module.cpp gives the caller what was raised.
class PythonError : public std::runtime_error {
 public:
  /// The interpreter lock is held.
  explicit PythonError(const pybind11::error_already_set& error);
  void restore() const { pybind11::error_already_set(*error_).restore(); }

 private:
  std::shared_ptr<pybind11::error_already_set> error_;
};

}  // namespace mortier::python
