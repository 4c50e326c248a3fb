// How the solution of a step ended.
#pragma once

#include <string>
#include <utility>

#include "solver/state.h"

namespace mortier {

/// Where the iterate of a step that is not solved is furthest off the material law.
struct StuckPlace {
  int body = 0;
  int triangle = 0;        ///< of its mesh, from 0; in space a tetrahedron
  SpacePoint at{0, 0, 0};  ///< where the stress is taken there [m]
  double residual = 0;     ///< |H^-1 r|, as in Certificate::materialResidual
  double time = 0;         ///< at which the step was to end [s]
};

/// Why a step is not solved.
enum class Reason {
  none,         ///< it is
  unconverged,  ///< not in the linear solves that are allowed, or not by this method
  singular,     ///< a tangent cannot be factorised
  contact,      ///< the contact problem of a linear solve was not solved
  overlap,      ///< bodies overlap where no contact holds them apart
  unheld        ///< contact cannot balance the load
};

struct StepOutcome {
  SolutionMethod method = SolutionMethod::newton;
  Reason reason = Reason::unconverged;
  std::string detail;      ///< one line; where contact cannot balance the load it names the motion
  int iterations = 0;      ///< linear solves with a new tangent
  int factorisations = 0;  ///< matrices factorised, all bodies
  Certificate certificate;

  [[nodiscard]] bool converged() const { return reason == Reason::none; }
  [[nodiscard]] bool unheld() const { return reason == Reason::unheld; }

  /// \returns false, for a caller that ends with it.
  bool fail(Reason why, std::string text) {
    reason = why;
    detail = std::move(text);
    return false;
  }
  void converge(const Certificate& found) {
    reason = Reason::none;
    detail.clear();
    certificate = found;
  }
  /// The outcome of what was tried next, with the work done before.
  void follow(StepOutcome next) {
    next.iterations += iterations;
    next.factorisations += factorisations;
    *this = std::move(next);
  }
};

}  // namespace mortier
