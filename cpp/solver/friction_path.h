// The sets of a contact problem with friction by following a path (Lemke's idea, on sets). With
//   q(tau) = q + tau d,   d > 0 on gaps, on slips 0 or, where a limit c holds, -d/2 max(1, mu) of its gap,
// everything is open and slips for large tau. From there tau decreases to 0; where a force, a gap, a slip or
// the distance of a shear force from its bound becomes zero, the node changes its state and the path
// continues: tau decreases where det A(sets) > 0 and increases where it is negative. For W positive definite
// the only solution of q = d without limits is zero (x'd >= 0), so the path is bounded; no piece of it is
// visited twice, so it ends at tau = 0 (docs/theory.md). The solution found in this way has det A > 0.
#pragma once

#include <optional>
#include <vector>

#include "solver/friction_sets.h"

namespace mortier {

/// \param events  changes of set are added here.
/// \returns nothing where the path cannot be followed: two events at one tau that are not the same, or
/// rounding.
std::optional<FrictionSets> followPath(const FrictionSystem& system, int& events);

/// The same, on beyond tau = 0 down to -3 times the largest |q|/d: the sets on all passages
/// through tau = 0, downwards (det A > 0) and upwards, in their order. A path that is lost has those so far.
std::vector<FrictionSets> followPathBeyond(const FrictionSystem& system, int& events);

}  // namespace mortier
