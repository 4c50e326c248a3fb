// The solutions of a contact problem with friction on its path (friction_path.h). The first passage of the
// path through tau = 0 is a solution with det A > 0. If there are others, as for a wedge that jams, slides,
// or is in an unstable state in between (det A < 0), the path continued beyond tau = 0 returns to most of
// them.
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
