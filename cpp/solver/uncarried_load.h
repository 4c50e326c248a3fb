// The part of the load on rigid motions that contact cannot carry, whatever the bodies' compliance.
#pragma once

#include <optional>

#include "solver/complementarity.h"

namespace mortier {

/// The least squares
///   z = load - G' x,   |z| least over p >= 0, |t| <= mu p,
/// by active sets (Lawson and Hanson 1974, NNLS), whose columns are the edges of the cones of friction. Where
/// z is not zero no forces balance the load, and z is a motion that the load drives and that no condition
/// resists (Farkas): nothing is pressed, load . z = |z|^2. The forces along conditions with a limit (Tresca)
/// are taken as free, which may hide a motion and shows none that is held. None where z is rounding.
/// \param load  of the balance: G' x = load
std::optional<Vector> uncarriedLoad(const ContactProblem& problem, const Vector& load);

}  // namespace mortier
