// What a wrong input is answered with.
#pragma once

#include <string>

#include "base/error.h"

namespace mortier {

/// The message of the Error that `f` throws, or "no error".
template <class Error = InputError, class F>
std::string messageOf(const F& f) {
  try {
    static_cast<void>(f());
  } catch (const Error& error) {
    return error.what();
  }
  return "no error";
}

}  // namespace mortier
