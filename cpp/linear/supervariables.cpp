#include "linear/supervariables.h"

#include <algorithm>
#include <array>
#include <mutex>
#include <new>
#include <numeric>
#include <optional>
#include <string>

#include "base/child_process.h"
#include "base/error.h"
#include "base/interrupt.h"
#include "linear/cholmod_common.h"

namespace mortier {
namespace {

/// METIS's order of a pattern. \pre none other of this process calls METIS
std::vector<int> orderOf(Columns& columns) {
  CholmodCommon common;
  std::vector<int> permutation(columns.start.size() - 1);
  cholmod_sparse A = lowerTriangle(columns.start, columns.rows);
  if (cholmod_metis(&A, nullptr, 0, 1, permutation.data(), &common) == 0) {
    // METIS traps SIGTERM and takes it for an error of its own, of which there is no other here.
    if (common->status == CHOLMOD_OUT_OF_MEMORY) throw std::bad_alloc();
    requestInterrupt();
    stopIfInterrupted();
  }
  return permutation;
}

/// The same from a child process; nothing where that did not come to its end.
std::vector<int> orderAside(Columns& columns) {
  const auto work = [&] {
    const std::vector<int> order = orderOf(columns);
    return std::string(reinterpret_cast<const char*>(order.data()), order.size() * sizeof(int));
  };
  std::vector<int> order;
  try {
    std::optional<ChildProcess> child;
    {
      const std::lock_guard noneInUse(
          metisInUse);  // a lock of its random numbers would stay shut in the child
      child.emplace(work, "METIS");
    }
    const std::string bytes = child->answer();
    order.resize(bytes.size() / sizeof(int));
    std::copy_n(bytes.data(), bytes.size(), reinterpret_cast<char*>(order.data()));
  } catch (const OutputError&) {
  } catch (const InputError&) {
  }
  return order;
}

/// METIS's order of the columns. Of many in a child process: an interruption ends it, and several threads may
/// wait for one each.
std::vector<int> fillReducingOrder(Columns& columns) {
  constexpr size_t worthAProcess = 10000;  // equations
  if (columns.start.size() < 2) return {};
  std::vector<int> permutation;
  if (columns.start.size() > worthAProcess) permutation = orderAside(columns);
  if (permutation.empty()) {
    const std::lock_guard alone(metisInUse);
    permutation = orderOf(columns);
  }
  return permutation;
}

/// Of each equation whether it couples otherwise than the one before it. \param placeOf  among those kept
std::vector<char> beginnings(const SparsePattern& of, const std::vector<int>& placeOf) {
  std::vector<char> begins(of.size + 1, 0);
  for (int j = 0; j < of.size; ++j) {
    const auto begin = of.rows.begin() + of.columnStart[j];
    const auto end = of.rows.begin() + of.columnStart[j + 1];
    for (auto row = begin; row != end; ++row) {
      if (row + 1 == end || row[1] != *row + 1) begins[*row + 1] = 1;
      if (row != begin ? row[-1] != *row - 1 : *row != j || !of.symmetric) begins[*row] = 1;
    }
    if (j == 0) {
      begins[j] = 1;
      continue;
    }
    const auto before = of.rows.begin() + of.columnStart[j - 1];
    if (of.symmetric && !std::equal(before + 1, begin, begin, end)) begins[j] = 1;
    if (placeOf[j] != (placeOf[j - 1] < 0 ? -1 : placeOf[j - 1] + 1)) begins[j] = 1;
  }
  return begins;
}

/// Pairs of positions below `size`: all that the first one couples with, the second one does as well. Of two
/// with the same couplings the second one comes first. Nothing where they are too many, as in dense patterns.
std::vector<std::array<int, 2>> coveredPositions(const SparsePattern& pattern,
                                                 const std::vector<int>& position, int size) {
  std::vector<int> start(size + 1, 0);
  const auto forEach = [&](auto visit) {
    for (int j = 0; j < pattern.size; ++j)
      for (int k = pattern.columnStart[j]; k < pattern.columnStart[j + 1]; ++k) {
        const int a = position[j];
        const int b = position[pattern.rows[k]];
        if (a >= size || b >= size) continue;
        visit(a, b);
        if (a != b && pattern.symmetric) visit(b, a);
      }
  };
  forEach([&](int a, int) { ++start[a + 1]; });
  std::partial_sum(start.begin(), start.end(), start.begin());
  std::vector<int> neighbours(start[size]);
  std::vector<int> next(start.begin(), start.end() - 1);
  forEach([&](int a, int b) { neighbours[next[a]++] = b; });

  constexpr size_t worthIt = 100;  // visits of an entry
  size_t visits = 0;
  std::vector<std::array<int, 2>> pairs;
  std::vector<int> metBy(size, -1);
  const auto degree = [&](int i) { return start[i + 1] - start[i]; };
  for (int by = 0; by < size; ++by) {
    for (int k = start[by]; k < start[by + 1]; ++k) metBy[neighbours[k]] = by;
    for (int k = start[by]; k < start[by + 1]; ++k) {
      const int i = neighbours[k];
      if (i == by || degree(i) > degree(by) || (degree(i) == degree(by) && i < by)) continue;
      const auto end = neighbours.begin() + start[i + 1];
      const auto other =
          std::find_if(neighbours.begin() + start[i], end, [&](int each) { return metBy[each] != by; });
      if (other == end) pairs.push_back({i, by});
      visits += other - (neighbours.begin() + start[i]);
    }
    if (visits > worthIt * neighbours.size()) return {};
  }
  return pairs;
}

}  // namespace

Columns permuted(const SparsePattern& pattern, const std::vector<int>& position, int size, int clique) {
  Columns result;
  std::vector<int> count(size + 1, 0);
  const auto forEach = [&](auto visit) {
    for (int j = 0; j < pattern.size; ++j)
      for (int k = pattern.columnStart[j]; k < pattern.columnStart[j + 1]; ++k) {
        const int row = std::max(position[j], position[pattern.rows[k]]);
        const int column = std::min(position[j], position[pattern.rows[k]]);
        if (row < size && column < clique && (pattern.symmetric || pattern.rows[k] >= j)) visit(row, column);
      }
    for (int column = clique; column < size; ++column)
      for (int row = column; row < size; ++row) visit(row, column);
  };
  forEach([&](int, int column) { ++count[column + 1]; });
  std::partial_sum(count.begin(), count.end(), count.begin());
  result.start = count;
  result.rows.resize(count[size]);
  forEach([&](int row, int column) { result.rows[count[column]++] = row; });
  for (int j = 0; j < size; ++j)
    std::sort(result.rows.begin() + result.start[j], result.rows.begin() + result.start[j + 1]);
  return result;
}

Supervariables::Supervariables(const SparsePattern& equations, const std::vector<int>& keptEquations) {
  std::vector<int> placeOf(equations.size, -1);
  for (size_t k = 0; k < keptEquations.size(); ++k) placeOf[keptEquations[k]] = static_cast<int>(k);
  const std::vector<char> begins = beginnings(equations, placeOf);
  std::vector<int> runOf(equations.size);
  for (int i = 0; i < equations.size; ++i) {
    if (begins[i] != 0) first.push_back(i);
    runOf[i] = static_cast<int>(first.size()) - 1;
  }
  const auto count = static_cast<int>(first.size());
  first.push_back(equations.size);
  for (const int equation : keptEquations)
    if (first[runOf[equation]] == equation) kept.push_back(runOf[equation]);
  pattern = {count, equations.symmetric, {0}, {}};
  for (int run = 0; run < count; ++run) {
    for (int k = equations.columnStart[first[run]]; k < equations.columnStart[first[run] + 1]; ++k)
      if (const int row = equations.rows[k]; first[runOf[row]] == row) pattern.rows.push_back(runOf[row]);
    pattern.columnStart.push_back(pattern.entries());
  }
}

// A run whose couplings are among those of others, as the middle of an edge has those of both ends, goes with
// the first of these: what separates them separates it as well. So METIS orders the vertices of quadratic
// elements only, an eighth of the nodes in space.
std::vector<int> orderOfSupervariables(const Supervariables& supervariables, const SparsePattern& equations) {
  const int size = supervariables.pattern.size;
  std::vector<int> position(size, 0);
  const int interior = size - static_cast<int>(supervariables.kept.size());
  for (size_t k = 0; k < supervariables.kept.size(); ++k)
    position[supervariables.kept[k]] = interior + static_cast<int>(k);
  std::vector<int> order;
  for (int i = 0; i < size; ++i)
    if (position[i] < interior) {
      position[i] = static_cast<int>(order.size());
      order.push_back(i);
    }
  std::vector<std::array<int, 2>> pairs = coveredPositions(supervariables.pattern, position, interior);
  std::vector<int> placeOf(interior, 0);  // among those that METIS orders; -1 of the others
  for (const auto& [covered, by] : pairs) placeOf[covered] = -1;
  std::vector<int> ordered;
  for (int i = 0; i < interior; ++i)
    if (placeOf[i] == 0) ordered.push_back(i);
  if (ordered.size() > static_cast<size_t>(interior) / 2) {
    pairs.clear();
    ordered.resize(interior);
    std::iota(ordered.begin(), ordered.end(), 0);
  }
  // METIS finds supervariables itself, and tries two separators where there are.
  std::vector<int> runAt;  // of the equations that are ordered
  std::vector<int> equationAt(equations.size, equations.size);
  for (const int i : ordered)
    for (int equation = supervariables.first[order[i]]; equation < supervariables.first[order[i] + 1];
         ++equation) {
      equationAt[equation] = static_cast<int>(runAt.size());
      runAt.push_back(i);
    }
  const auto count = static_cast<int>(runAt.size());
  Columns columns = permuted(equations, equationAt, count, count);
  std::fill(placeOf.begin(), placeOf.end(), -1);
  int place = 0;
  for (const int equation : fillReducingOrder(columns))
    if (const int run = runAt[equation]; placeOf[run] < 0) placeOf[run] = place++;

  std::vector<int> first = placeOf;
  for (const auto& [covered, by] : pairs)
    if (const int of = placeOf[by]; of >= 0 && (first[covered] < 0 || of < first[covered]))
      first[covered] = of;
  std::vector<int> sorted(interior);
  std::iota(sorted.begin(), sorted.end(), 0);
  std::stable_sort(sorted.begin(), sorted.end(), [&](int a, int b) { return first[a] < first[b]; });
  for (int& i : sorted) i = order[i];
  sorted.insert(sorted.end(), supervariables.kept.begin(), supervariables.kept.end());
  return sorted;
}

}  // namespace mortier
