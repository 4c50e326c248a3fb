#pragma once

#include "base/error.h"

namespace mortier {

/// A datum that is not finite somewhere at some time: wrong input (exit code 2). In a run that has begun it
/// ends the step, and the last good state is kept (exit code 1).
class DatumError : public InputError {
 public:
  using InputError::InputError;
};

}  // namespace mortier
