#pragma once

#include <string>
#include <utility>

#include "base/error.h"

namespace mortier {

/// A wrong input that is a fault of its own in docs/check.md.
class FaultError : public InputError {
 public:
  FaultError(const std::string& message, std::string id) : InputError(message), id_(std::move(id)) {}
  [[nodiscard]] const std::string& id() const { return id_; }

 private:
  std::string id_;
};

}  // namespace mortier
