// What a march carries from step to step beside the State. With state and memory a march that was stopped
// resumes as if it had not been; both are plain data.
#pragma once

#include <vector>

#include "base/two_part_vector.h"
#include "solver/state.h"
#include "time/report.h"

namespace mortier {

/// The change of displacement and stress of a body from the start of a step to one of its stages.
struct BodyIncrement {
  TwoPartVector displacement;  ///< by dofs [m]
  Matrix stress;               ///< components x points [Pa]
};

/// The norms of an error in time, or of what it is compared with (error_norms.h).
struct ErrorNorms {
  double stress = 0;        ///< energy norm [sqrt(J/m)]
  double displacement = 0;  ///< mean over the bodies [m]
  double friction = 0;      ///< dissipated by friction since the run began [J/m]
};

/// What slips and flows in a step, or by how much that is off: exact less computed.
struct SlipAndWork {
  std::vector<Vector> slip;    ///< T u per interface [m]; empty: none
  double work = 0;             ///< that friction dissipates [J/m]
  std::vector<Matrix> strain;  ///< viscoplastic, per body; empty: none
};

/// Of steps chosen by their error.
struct ControllerMemory {
  int trial = 0;                    ///< runs begun; 0: the march has not begun
  bool shortestInaccurate = false;  ///< a step is wrong by more than the tolerance and cannot be shorter
  int crossing = 0;                 ///< iterations until the error passed the tolerance; 0: it has not
  State start;                      ///< of each
  double timeStep = 0;              ///< to try next [s]
  ErrorNorms scale;                 ///< by which errors of steps are measured
  ErrorNorms largest;               ///< over the run so far: the scale of its relative error
  double local = 0;                 ///< what the error of a step may be, relative
  std::vector<Matrix> strain;       ///< error of the viscoplastic strain, exact less computed; empty: none
  ErrorNorms error;                 ///< what it makes of stress and displacement
  ErrorNorms worst;                 ///< the largest of any step so far
  // With friction steps come in pairs, which are compared with one step of twice the length.
  SlipAndWork slip;    ///< of all pairs so far
  SlipAndWork missed;  ///< by the pair whose first step has been taken
  double pairEnd = 0;  ///< where its second one ends [s]
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
