// The elimination tree cut into pieces that threads work on. The cut depends on the tree alone, so what is
// computed does not depend on the number of threads.
#pragma once

#include <vector>

#include "linear/elimination.h"

namespace mortier {

/// Fronts [first, last]: either whole subtrees, all below the same front, or one front above such pieces.
struct Piece {
  int first = 0;
  int last = 0;
  size_t stack = 0;           ///< doubles that the updates need while the piece is worked on
  size_t vectorStack = 0;     ///< the same for a vector by the rows of the fronts
  std::vector<int> children;  ///< pieces below this one; none for subtrees
};

struct Pieces {
  std::vector<Piece> all;   ///< children before parents
  std::vector<int> parent;  ///< piece above, -1 for none
};

Pieces cutIntoPieces(const std::vector<Front>& fronts);

}  // namespace mortier
