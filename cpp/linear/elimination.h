// The symbolic side of a multifrontal factorisation: in which order a symmetric pattern is eliminated, in
// which fronts, and where every entry goes. Done once for a body (Duff and Reid 1983; ordering and supernodes
// by METIS and CHOLMOD).
#pragma once

#include <cstddef>
#include <cstdint>
#include <vector>

#include "linear/condensing_solver.h"

namespace mortier {

/// A dense matrix over `rows`; the first `pivots` of them are eliminated in it, the others are updated and
/// passed on. It is held in three parts, column major: the panel (rows x pivots), the upper part transposed
/// (updates x pivots; none where symmetric) and the update (updates x updates).
struct Front {
  int parent = -1;  ///< the front that takes the update, -1 for none
  int pivots = 0;
  std::vector<int> rows;      ///< positions in the elimination order, ascending
  std::vector<int> inParent;  ///< for each updated row, its index among the parent's rows
  std::vector<int> children;  ///< fronts whose update is assembled here, in the order in which they come
  size_t firstEntry = 0;      ///< entries [firstEntry, next front's firstEntry) are assembled here

  [[nodiscard]] size_t updates() const { return rows.size() - pivots; }
  [[nodiscard]] size_t panelSize() const { return rows.size() * pivots; }
};

struct Elimination {
  int size = 0;
  int kept = 0;               ///< the last `kept` positions are never eliminated; the last front holds them
  std::vector<int> order;     ///< position -> equation
  std::vector<Front> fronts;  ///< children before parents
  std::vector<int> entries;   ///< entry of the pattern, grouped by front
  std::vector<uint32_t> positions;  ///< and its place in panel, upper part and update, one after the other
};

/// \param kept  equations to be left, in this order, at the end.
/// \throws Interrupted
Elimination analyse(const SparsePattern& pattern, const std::vector<int>& kept);

/// Fronts [first, last]: either whole subtrees, all below the same front, or one front above such pieces.
struct Piece {
  int first = 0;
  int last = 0;
  size_t stack = 0;           ///< doubles that the updates need while the piece is worked on
  size_t vectorStack = 0;     ///< the same for a vector by the rows of the fronts
  std::vector<int> children;  ///< pieces below this one; none for subtrees
};

/// The elimination tree cut into pieces that threads work on.
struct Pieces {
  std::vector<Piece> all;   ///< children before parents
  std::vector<int> parent;  ///< piece above, -1 for none
};

/// The cut depends on the tree alone, so what is computed does not depend on the number of threads.
Pieces cutIntoPieces(const std::vector<Front>& fronts);

}  // namespace mortier
