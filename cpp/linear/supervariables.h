// In which order the equations of a sparse pattern are eliminated: by METIS, of as few vertices as will do.
#pragma once

#include <vector>

#include "linear/condensing_solver.h"

namespace mortier {

/// The lower triangle of a pattern by columns, rows ascending.
struct Columns {
  std::vector<int> start{0};
  std::vector<int> rows;
};

/// The pattern in new positions, lower triangle; `size` positions from 0, entries outside dropped. `clique`
/// makes the positions from there on couple with each other.
Columns permuted(const SparsePattern& pattern, const std::vector<int>& position, int size, int clique);

/// Supervariables of a pattern, runs of equations with the same couplings, as those of a node: ordered and
/// analysed in a fraction of the time.
struct Supervariables {
  Supervariables(const SparsePattern& equations, const std::vector<int>& keptEquations);
  std::vector<int> first;  ///< equation of each, and the number of all
  std::vector<int> kept;
  SparsePattern pattern;  ///< of these
};

/// Fill-reducing order of those that are not kept, those that are appended.
/// \throws Interrupted
std::vector<int> orderOfSupervariables(const Supervariables& supervariables, const SparsePattern& equations);

}  // namespace mortier
