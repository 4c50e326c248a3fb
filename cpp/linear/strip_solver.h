// Systems whose graph is long and narrow, that of a strip of triangles along a line: eliminated from one end
// to the other in the order of Cuthill and McKee (1969), in fronts of consecutive equations (Irons 1970). It
// costs no analysis beyond a walk through the graph.
#pragma once

#include <memory>

#include "linear/condensing_solver.h"

namespace mortier {

/// For a symmetric pattern, nothing kept; where the graph is not narrow it is multifrontalSolver().
std::unique_ptr<CondensingSolver> stripSolver(const SparsePattern& pattern);

}  // namespace mortier
