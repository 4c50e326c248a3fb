// Sparse matrices from entries in any order.
#pragma once

#include <vector>

#include "linear/sparse_pattern.h"

namespace mortier {

struct MatrixEntry {
  int column = 0;
  int row = 0;
  double value = 0;
};

/// A symmetric matrix by its lower triangle.
struct SparseSymmetric {
  SparsePattern pattern;
  std::vector<double> values;
};

/// Entries (row >= column) of one place are added, in their order. \pre every column has one on the diagonal
SparseSymmetric assembled(int size, const std::vector<MatrixEntry>& entries);

}  // namespace mortier
