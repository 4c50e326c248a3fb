// Sparse matrices by their entries.
#pragma once

#include <Eigen/SparseCore>
#include <vector>

namespace mortier {

using Triplets = std::vector<Eigen::Triplet<double>>;

template <class Sparse = Eigen::SparseMatrix<double>>
Sparse assembled(Eigen::Index rows, Eigen::Index columns, const Triplets& entries) {
  Sparse matrix(rows, columns);
  matrix.setFromTriplets(entries.begin(), entries.end());
  return matrix;
}

/// Calls visit(row, column, value), in the order of memory.
template <class Sparse, class Visit>
void forEachEntry(const Sparse& matrix, const Visit& visit) {
  for (int k = 0; k < matrix.outerSize(); ++k)
    for (typename Sparse::InnerIterator entry(matrix, k); entry; ++entry)
      visit(static_cast<int>(entry.row()), static_cast<int>(entry.col()), entry.value());
}

}  // namespace mortier
