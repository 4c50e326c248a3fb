// What the rounding of a linear solve left of closed gaps. Lines that are long beside the thickness of a
// layer multiply it.
#include <utility>

#include "solver/methods.h"

namespace mortier {

bool worthCorrecting(const StepSystem& system, const Step& step, double tolerance, const Iterate& iterate) {
  // Sparse contact has its factors at hand and is always corrected.
  constexpr double ofTolerance = 1e-3;
  return system.opened(step, iterate) > (system.sparse() ? 0 : ofTolerance * tolerance);
}

std::optional<Certificate> corrected(StepSystem& system, const StepSystem::Linearised& linearised,
                                     const Step& step, double weight, const NewtonLimits& limits,
                                     Iterate& iterate) {
  Iterate next = iterate;
  StepOutcome outcome;
  if (!linearised.keepFactors().solve(step, next, outcome)) return std::nullopt;
  const double residual = system.linearise(step, next, weight, limits.anticipate).residual();
  if (!(residual <= limits.tolerance)) return std::nullopt;
  if (!(system.opened(step, next) < system.opened(step, iterate))) return std::nullopt;
  const Certificate certificate = system.certify(step, next, residual);
  iterate = std::move(next);
  return certificate;
}

}  // namespace mortier
