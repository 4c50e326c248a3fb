// Multifrontal solvers of which several are made at once.
#pragma once

#include "linear/condensing_solver.h"

namespace mortier {

/// As multifrontalSolver(); METIS orders each in a process of its own.
std::unique_ptr<CondensingSolver> multifrontalSolverOfOneBody(const SparsePattern& pattern,
                                                              const std::vector<int>& kept);

}  // namespace mortier
