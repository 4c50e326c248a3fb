// The solutions of a contact problem with friction that its path (friction_path.h) meets. Its first passage
// through tau = 0 is a solution with det A > 0. Where there are others, as those of a wedge that holds, lets
// go, or is between the two (det A < 0), the path followed on beyond tau = 0 comes back to most of them.
#pragma once

#include <optional>
#include <vector>

#include "solver/friction_sets.h"

namespace mortier {

/// The first of them, with det A > 0. Where two things happen at once, as they do in a symmetric problem, the
/// path has a corner that it cannot turn: it is followed on a problem nearby then.
/// \param events  changes of set are added here
std::optional<FrictionSolution> firstOnPath(FrictionSystem& system, int& events);

/// All that it meets, each once, in its order. \param taken  one that is known, first in the list.
std::vector<FrictionSolution> solutionsOnPath(const FrictionProblem& problem, const Vector& q,
                                              const FrictionSolution& taken);

}  // namespace mortier
