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

/// For a step in which no load and no support changes and nothing flows: checks that the state solves the
/// step as it is, without a linear solve.
StepOutcome rest(StepSystem& system, const Step& step, Iterate& iterate);

struct NewtonLimits {
  int iterations = 0;
  double tolerance = 0;       ///< material residual of the solution
  bool anticipate = false;    ///< material/material.h
  bool elasticFirst = false;  ///< the first iteration takes the bodies as elastic
  bool turning = false;  ///< given up at once where a body that flowed is thrown far off, as where it unloads
  bool shortens = false;  ///< a line search, where every law is linear or linearised at its strain
};

/// Newton's method from `iterate`, at this weight [s].
StepOutcome newton(StepSystem& system, const Step& step, double weight, const NewtonLimits& limits,
                   Iterate& iterate);

/// Of each body: stresses on the law, linearised where the strain leads: there the predictor is on it.
std::vector<Matrix> stressesOnLaw(const StepSystem::Linearised& linearised, size_t bodies);
/// Where the slope of the energy at the end of a linear solve is positive, and more than half of that at its
/// beginning `before`: moves the iterate back to where the slope is nearly zero.
/// \param linearised  at the iterate  \returns the law there
StepSystem::Linearised shortened(StepSystem& system, const Step& step, double weight,
                                 const std::vector<Matrix>& stressBefore, const Iterate& before,
                                 StepSystem::Linearised linearised, Iterate& iterate);

/// Whether gaps that rounding left of closed conditions are worth another linear solve.
bool worthCorrecting(const StepSystem& system, const Step& step, double tolerance, const Iterate& iterate);
/// That, with the same factors. \returns the certificate of what it made of the iterate; none, and the
/// iterate as it was, where that is no better.
std::optional<Certificate> corrected(StepSystem& system, const StepSystem::Linearised& linearised,
                                     const Step& step, double weight, const NewtonLimits& limits,
                                     Iterate& iterate);

/// Follows the law along its central path (material/interior_path.h); contact is exact in every linear
/// solve.
StepOutcome interiorPoint(StepSystem& system, const Step& step, int maxIterations, Iterate& iterate);

/// Where curves of solutions are a maze, the step as the rest state of damped motion (pseudo-transient
/// continuation, Kelley and Keyes 1998): beside the stress s on the law acts that of a viscosity in parallel,
///   s + E B (du - du_n)/delta,
/// du_n where the motion was last. For small delta, the length of a step of it, the tangent is that of an
/// elastic body, whatever the law; where the motion ends the second term vanishes. Delta doubles with each
/// step and falls where one cannot be solved.
StepOutcome restOfDampedMotion(StepSystem& system, const Step& step, int maxIterations, Iterate& iterate);

/// The penalty-duality method of Bermudez and Moreno, from `iterate`.
StepOutcome penaltyDuality(StepSystem& system, const Step& step, Iterate& iterate);

}  // namespace mortier
