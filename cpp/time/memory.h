// What a march carries from step to step beside the State. State and memory together are all that it takes to
// go on from a step as if it had never stopped; both are plain data.
#pragma once

#include <vector>

#include "base/types.h"
#include "time/report.h"

namespace mortier {

/// What a body moved and took up between the start of a step and one of its stages.
struct BodyIncrement {
  Vector displacement;  ///< by dofs [m], carried as displacement + small
  Vector small;
  Matrix stress;  ///< components x points [Pa]
};

struct MarchMemory {
  double begin = 0;  ///< time at which the march began [s]
  RunReport run;     ///< so far
  /// Of the last step, by stage and body; empty after a step that gives no good guess of the next.
  std::vector<std::vector<BodyIncrement>> increments;
  double timeStep = 0;          ///< of `increments` [s]
  std::vector<char> libraries;  ///< bodies for which SuiteSparse has taken over
};

}  // namespace mortier
