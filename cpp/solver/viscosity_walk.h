// The solutions of a step for every viscosity, from that of almost elastic bodies to its own. Where a step
// has several solutions, the one at the end of this curve is taken (docs/decisions.md).
//
// The law of the step with 10^decades weight in place of weight has, for decades -> -infinity, the one
// solution of an elastic step. From there a curve of solutions leads to decades = 0, but `decades` may go up
// and down along it. The curve is followed by natural steps, which raise `decades`. Where they fail, because
// the curve turns back, it is followed by pseudo-arclength (Keller 1977; Allgower and Georg 1990), from the
// last place that is on the curve for certain.
#pragma once

#include <vector>

#include "solver/step_system.h"

namespace mortier {

/// How far a walk has come.
struct ViscosityWalk {
  ViscosityWalk(const Model& model, const Step& step);

  struct Place {
    double decades = 0;
    Iterate iterate;
  };
  /// Where to follow the curve from: the last place if all steps to it were solved accurately, else the first
  /// one. Steps that are solved roughly may jump off the curve.
  [[nodiscard]] Place startOfCurve() const;

  std::vector<Place> places;  ///< the start, which is not solved, and the last ones that are
  /// Decades by which the start is lowered where not even the first step can be taken from it; 0 where it is
  /// known to be low enough.
  double lower = 0;
  double pace;       ///< of natural steps, in decades
  double tolerance;  ///< material residual of their places
  double roughest;   ///< the tolerance when the walk last left its start
  std::vector<double>
      turns;  ///< where the curve turned back, in decades of the viscosity over that of the step
};

/// Natural steps: each starts from the place before and is solved roughly. Where one fails, the walk goes two
/// places back and takes shorter steps.
StepOutcome lowerViscosity(StepSystem& system, const Step& step, ViscosityWalk& walk, int maxIterations,
                           Iterate& solution);

/// Follows the curve by its arclength. Its direction at an iterate is the response of the step to the flow,
///   d(stress, displacement)/d decades = respond(log(10) weight G(s)),
/// and forwards is the sense in which the last step was taken. A step predicts in that direction, and
/// Newton's method corrects in the plane across it, with the viscosity as an unknown. The curve has a corner
/// wherever a triangle begins or ceases to flow: steps become short before sharp ones.
StepOutcome followCurve(StepSystem& system, const Step& step, ViscosityWalk& walk, int maxIterations,
                        Iterate& solution);

}  // namespace mortier
