// What a march carries from step to step beside the State. State and memory together are all that it takes to
// go on from a step as if it had never stopped; both are plain data.
#pragma once

#include <vector>

#include "base/two_part_vector.h"
#include "solver/state.h"
#include "time/report.h"

namespace mortier {

/// What a body moved and took up between the start of a step and one of its stages.
struct BodyIncrement {
  TwoPartVector displacement;  ///< by dofs [m]
  Matrix stress;               ///< components x points [Pa]
};

/// Of steps chosen by their error.
struct ControllerMemory {
  double timeStep = 0;      ///< to try next [s]; 0: the march has not begun
  double stress = 0;        ///< scale of the error of the stress: its largest energy norm so far [sqrt(J/m)]
  double displacement = 0;  ///< scale of that of the displacement, a mean over the bodies [m]
};

struct MarchMemory {
  double begin = 0;  ///< time at which the march began [s]
  RunReport run;     ///< so far
  /// Of the last step, by stage and body; empty after a step that gives no good guess of the next.
  std::vector<std::vector<BodyIncrement>> increments;
  double timeStep = 0;  ///< of `increments` [s]
  SolverMemory solver;
  ControllerMemory controller;
};

}  // namespace mortier
