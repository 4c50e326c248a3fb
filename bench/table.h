// Figures beside their targets.
#pragma once

#include <cstdio>

namespace mortier::bench {

/// One row of the table. \param atMost  the target is an upper bound
inline void printRow(const char* name, double triangles, double value, double target, bool atMost = true) {
  const bool met = atMost ? value <= target : value >= target;
  std::printf("%-58s %9.3g %9.3f %4s %6.3g   %s\n", name, triangles, value, atMost ? "<=" : ">=", target,
              met ? "met" : "NOT met");
}

}  // namespace mortier::bench
