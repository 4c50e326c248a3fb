#pragma once

#include <array>
#include <vector>

#include "base/types.h"

namespace mortier {

/// Contact at an earlier time, which has to go on: no gap may be smaller, nothing may press that did not.
/// Empty where it need not.
struct EarlierContact {
  std::vector<std::array<double, 2>> gaps;  ///< at begin and end of each piece [m]
  std::vector<Vector> pressures;            ///< coefficients of p^
};

}  // namespace mortier
