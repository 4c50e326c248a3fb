// Which entries of a square sparse matrix exist, by columns.
#pragma once

#include <vector>

namespace mortier {

struct SparsePattern {
  int size = 0;
  bool symmetric = true;  ///< only the lower triangle (row >= column) is held; otherwise all of a pattern
                          ///< that is structurally symmetric
  std::vector<int> columnStart;  ///< size + 1
  std::vector<int> rows;         ///< ascending in each column

  [[nodiscard]] int entries() const { return static_cast<int>(rows.size()); }
};

}  // namespace mortier
