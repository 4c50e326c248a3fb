// Texts with numbers by the patterns of printf.
#pragma once

#include <algorithm>
#include <cstdarg>
#include <cstdio>
#include <string>

#include "base/types.h"

namespace mortier {

/// At most 511 bytes of it.
[[gnu::format(printf, 1, 2)]] inline std::string formatted(const char* pattern, ...) {
  std::va_list arguments;
  va_start(arguments, pattern);
  char text[512];
  const int size = std::vsnprintf(text, sizeof text, pattern, arguments);
  va_end(arguments);
  return {text, static_cast<size_t>(std::clamp<int>(size, 0, sizeof text - 1))};
}

/// "(0.5, 1)", to four digits.
inline std::string placeText(const Point& place) {
  return formatted("(%.4g, %.4g)", place.x(), place.y());
}
/// The same, in space "(0.5, 1, 2)", to four digits.
inline std::string placeText(const SpacePoint& place, int dimension) {
  return dimension == 3 ? formatted("(%.4g, %.4g, %.4g)", place.x(), place.y(), place.z())
                        : placeText(Point(place.x(), place.y()));
}

}  // namespace mortier
