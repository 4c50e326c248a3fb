// Multifrontal solvers of which several are made at once, and those in single precision.
#pragma once

#include "linear/condensing_solver.h"

namespace mortier {

/// As multifrontalSolver(); METIS orders each in a process of its own.
std::unique_ptr<CondensingSolver> multifrontalSolverOfOneBody(const SparsePattern& pattern,
                                                              const std::vector<int>& kept);

/// The same by Cholesky in single precision: half of the memory and nearly of the time. What it solves is off
/// by the rounding of single precision times the condition of K; repeated solves for what is left take that
/// away.
std::unique_ptr<CondensingSolver> singleSolver(const SparsePattern& pattern, const std::vector<int>& kept);

}  // namespace mortier
