// The methods by which a step is solved, each on a linearised step of step_system.h. They leave the solution
// in `iterate`.
#pragma once

#include <optional>
#include <vector>

#include "solver/step_system.h"

namespace mortier {

// The solutions of a step for every viscosity, from that of almost elastic bodies to its own. Where a step
// has several solutions, the one at the end of this curve is taken (docs/decisions.md).
//
// The law of the step with 10^decades weight in place of weight has, for decades -> -infinity, the one
// solution of an elastic step. From there a curve of solutions leads to decades = 0, but `decades` may go up
// and down along it. The curve is followed by natural steps, which raise `decades`. Where they fail, because
// the curve turns back, it is followed by pseudo-arclength (Keller 1977; Allgower and Georg 1990), from the
// last place that is on the curve for certain.

/// The state of the continuation in the viscosity.
struct ViscosityContinuation {
  ViscosityContinuation(const Model& model, const Step& step);

  struct Place {
    double decades = 0;
    Iterate iterate;
  };
  /// Where to follow the curve from: the last place if all steps to it were solved accurately, else the first
  /// one. Steps that are solved roughly may jump off the curve.
  [[nodiscard]] Place startOfCurve() const;

  std::vector<Place> places;  ///< the start, which is not solved, and the last ones that are
  /// Decades by which the start is lowered where no step can be taken from it; 0 where it is low enough.
  double startReduction = 0;
  double stepSize;          ///< of natural steps, in decades
  double tolerance;         ///< material residual of their places
  double toleranceAtStart;  ///< the tolerance when it last left its start
  std::vector<double>
      turningPoints;  ///< where the curve turned back, in decades of the viscosity over that of the step
};

/// Natural steps: each starts from the place before and is solved roughly. Where one fails, it goes two
/// places back and takes shorter steps.
StepOutcome lowerViscosity(StepSystem& system, const Step& step, ViscosityContinuation& continuation,
                           int maxIterations, Iterate& solution);

/// Follows the curve by its arclength. Its direction at an iterate is the response of the step to the flow,
///   d(stress, displacement)/d decades = respond(log(10) weight G(s)),
/// and forwards is the sense in which the last step was taken. A step predicts in that direction, and
/// Newton's method corrects in the plane across it, with the viscosity as an unknown. The curve has a corner
/// wherever a triangle begins or ceases to flow: steps become short before sharp ones.
StepOutcome followCurve(StepSystem& system, const Step& step, ViscosityContinuation& continuation,
                        int maxIterations, Iterate& solution);

/// For a step in which no load and no support changes and nothing flows: checks that the state solves the
/// step as it is, without a linear solve.
StepOutcome rest(StepSystem& system, const Step& step, Iterate& iterate);

struct NewtonLimits {
  int iterations = 0;
  double tolerance = 0;       ///< material residual of the solution
  bool anticipate = false;    ///< material/material.h
  bool elasticFirst = false;  ///< the first iteration takes the bodies as elastic
  bool giveUpOnReversal =
      false;  ///< given up at once where a body that flowed is thrown far off, as where it unloads
  bool lineSearch = false;  ///< a line search, where every law is linear or linearised at its strain
};

/// Newton's method from `iterate`, at this weight [s].
StepOutcome newton(StepSystem& system, const Step& step, double weight, const NewtonLimits& limits,
                   Iterate& iterate);

/// Follows the law along its central path (material/interior_path.h); contact is exact in every linear
/// solve.
StepOutcome interiorPoint(StepSystem& system, const Step& step, int maxIterations, Iterate& iterate);

/// The penalty-duality method of Bermudez and Moreno, from `iterate`.
StepOutcome penaltyDuality(StepSystem& system, const Step& step, Iterate& iterate);

}  // namespace mortier
