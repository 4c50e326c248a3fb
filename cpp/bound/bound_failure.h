// What goes wrong inside a bound is the reason why there is none: the result of the run stays.
#pragma once

#include <exception>
#include <new>
#include <string>

namespace mortier {

inline std::string reasonOf(const std::exception& error) {
  return dynamic_cast<const std::bad_alloc*>(&error) != nullptr ? "there is no memory for it" : error.what();
}

}  // namespace mortier
