// Places in messages and logs.
#pragma once

#include <cstdio>
#include <string>

#include "base/types.h"

namespace mortier {

/// "(0.5, 1)", in space "(0.5, 1, 2)", to four digits.
inline std::string placeText(const SpacePoint& place, int dimension) {
  char text[96];
  std::snprintf(text, sizeof text, dimension == 3 ? "(%.4g, %.4g, %.4g)" : "(%.4g, %.4g)", place.x(),
                place.y(), place.z());
  return text;
}

}  // namespace mortier
