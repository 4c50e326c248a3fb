// Numbers in messages.
#pragma once

#include <cstdio>
#include <string>

namespace mortier {

/// With so many significant digits: "0.012" of two.
inline std::string digits(double value, int count = 2) {
  char text[32];
  return {text, static_cast<size_t>(std::snprintf(text, sizeof text, "%.*g", count, value))};
}

}  // namespace mortier
