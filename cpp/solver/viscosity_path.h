// The solutions of a step for every viscosity, followed as a curve: where continuation stops because the curve
// turns back, this goes round.
//
// The law of the step with 10^decades weight in place of weight has, for decades -> -infinity, the one solution of an
// elastic step. From there a curve of solutions leads to decades = 0 (docs/theory.md), but `decades` may go up and down
// along it. Its direction in an iterate is the response of the step to the flow,
//   d(stress, displacement)/d decades = respond(log(10) weight G(s)),
// forwards or backwards by the sign of the determinant of the tangent, contact included (Keller 1977; Allgower and Georg
// 1990): it rises while the sign is that of the start. A step along it predicts in that direction, and Newton's method
// corrects in the plane across it, the viscosity an unknown. The curve has a corner wherever a triangle begins or ceases
// to flow; where one is so sharp that the plane misses what follows, the direction beyond it, which an iterate of the
// corrector has, takes its place.
#pragma once

#include "solver/step.h"

namespace mortier {

class ViscosityPath {
 public:
  ViscosityPath(StepSolver& solver, const State& state0, const StepData& step);

  /// Follows the curve to its end, which becomes `solution`.
  StepOutcome follow(int maxIterations, Iterate& solution);
  /// Where it turned back, in decades of the viscosity over that of the step.
  [[nodiscard]] const std::vector<double>& turns() const { return turns_; }

 private:
  /// A direction of the curve, of length one: stresses over the yield stress, and decades.
  struct Direction {
    std::vector<Response> response;
    double decades = 0;
  };
  struct Place {
    Iterate iterate;
    double decades = 0;
  };
  /// What the corrector left.
  struct Correction {
    bool converged = false;
    bool found = false;  ///< a direction beyond a sharp corner
    int iterations = 0;
    Direction direction;  ///< of the curve, at the last linear solve
    Direction beyond;     ///< of the corner
  };

  Correction correct(const Direction& along, Place& place);
  StepOutcome finish(int maxIterations, const Direction& along, Iterate& solution);
  /// The direction at a place whose tangent has just been factorised.
  [[nodiscard]] Direction directionAt(const Place& place);
  void linearise(Place& place);
  [[nodiscard]] double dot(const std::vector<Response>& a, const std::vector<Response>& b) const;
  [[nodiscard]] double dot(const Direction& a, const Direction& b) const {
    return dot(a.response, b.response) + a.decades * b.decades;
  }
  static void move(const Direction& along, double length, Place& place);
  static Direction difference(const Place& a, const Place& b);

  StepSolver& solver_;
  const State& state0_;
  const StepData& step_;
  StepData eased_;  ///< the step at the viscosity of the last place
  std::vector<Vector> loads_;
  std::vector<double> unit_;  ///< of the stresses of each body
  double stiffness_ = 0;
  StepOutcome total_;
  int startSign_ = 1;
  double residual_ = 0;
  Place at_;
  std::vector<double> turns_;
};

}  // namespace mortier
