#include "linear/matrix_entries.h"

#include <numeric>

namespace mortier {
namespace {

/// The entries in the order of a key in [0, size), those of one key as they came.
template <class Key>
std::vector<MatrixEntry> sorted(int size, const std::vector<MatrixEntry>& entries, const Key& key) {
  std::vector<int> next(size + 1, 0);
  for (const MatrixEntry& entry : entries) ++next[key(entry) + 1];
  std::partial_sum(next.begin(), next.end(), next.begin());
  std::vector<MatrixEntry> result(entries.size());
  for (const MatrixEntry& entry : entries) result[next[key(entry)]++] = entry;
  return result;
}

}  // namespace

SparseSymmetric assembled(int size, const std::vector<MatrixEntry>& entries) {
  SparseSymmetric result;
  SparsePattern& pattern = result.pattern;
  pattern.size = size;
  pattern.columnStart.assign(size + 1, 0);
  const auto byRows = sorted(size, entries, [](const MatrixEntry& entry) { return entry.row; });
  int column = -1;
  for (const MatrixEntry& entry : sorted(size, byRows, [](const MatrixEntry& each) { return each.column; })) {
    if (entry.column != column || entry.row != pattern.rows.back()) {
      pattern.rows.push_back(entry.row);
      result.values.push_back(0);
      ++pattern.columnStart[entry.column + 1];
    }
    column = entry.column;
    result.values.back() += entry.value;
  }
  std::partial_sum(pattern.columnStart.begin(), pattern.columnStart.end(), pattern.columnStart.begin());
  return result;
}

}  // namespace mortier
