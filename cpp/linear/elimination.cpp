#include "linear/elimination.h"

#include <algorithm>
#include <limits>
#include <memory>
#include <mutex>
#include <new>
#include <numeric>
#include <optional>
#include <stdexcept>
#include <string>
#include <type_traits>

#include "base/child_process.h"
#include "base/error.h"
#include "base/interrupt.h"
#include "linear/cholmod_common.h"

namespace mortier {
namespace {

struct Columns {
  std::vector<int> start{0};
  std::vector<int> rows;
};

/// The pattern in new positions, lower triangle; `size` positions from 0, entries outside dropped. `clique`
/// makes the positions from there on couple with each other.
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

/// Fill-reducing order of the interior alone, the kept equations appended.
std::vector<int> fillReducingOrder(const SparsePattern& pattern, const std::vector<int>& kept, bool aside) {
  constexpr int worthAProcess = 10000;  // equations
  std::vector<int> position(pattern.size, 0);
  const int interior = pattern.size - static_cast<int>(kept.size());
  for (size_t k = 0; k < kept.size(); ++k) position[kept[k]] = interior + static_cast<int>(k);
  std::vector<int> equation;
  for (int i = 0; i < pattern.size; ++i)
    if (position[i] < interior) {
      position[i] = static_cast<int>(equation.size());
      equation.push_back(i);
    }
  std::vector<int> permutation;
  if (interior > 0) {
    Columns columns = permuted(pattern, position, interior, interior);
    const UninterruptibleCall deaf;
    if (aside && interior >= worthAProcess) permutation = orderAside(columns);
    if (permutation.empty()) {
      const std::lock_guard alone(metisInUse);
      permutation = orderOf(columns);
    }
  }
  std::vector<int> order(pattern.size);
  for (int i = 0; i < interior; ++i) order[i] = equation[permutation[i]];
  std::copy(kept.begin(), kept.end(), order.begin() + interior);
  return order;
}

/// Of a factor: the order, and of each supernode its first column and rows.
struct Supernodes {
  std::vector<int> permutation, super, rowStart, rows;
};

/// \param Index  of CHOLMOD's numbers \returns nothing where they do not suffice
template <class Index>
std::optional<Supernodes> supernodesOf(Columns& columns) {
  constexpr bool isLong = !std::is_same_v<Index, int>;
  std::vector<Index> start(isLong ? columns.start.begin() : columns.start.end(), columns.start.end());
  std::vector<Index> rows(isLong ? columns.rows.begin() : columns.rows.end(), columns.rows.end());
  cholmod_sparse A = lowerTriangle(columns.start, columns.rows);
  if (isLong) {
    A.p = start.data();
    A.i = rows.data();
    A.itype = CHOLMOD_LONG;
  }
  std::vector<Index> identity(A.nrow);
  std::iota(identity.begin(), identity.end(), 0);
  cholmod_common common;
  if (isLong)
    cholmod_l_start(&common);
  else
    cholmod_start(&common);
  common.print = 0;
  common.supernodal = CHOLMOD_SUPERNODAL;
  common.nmethods = 1;
  common.method[0].ordering = CHOLMOD_GIVEN;
  common.nrelax[0] = 2;
  common.nrelax[1] = 8;
  common.nrelax[2] = 24;
  const UninterruptibleCall deaf;
  cholmod_factor* L = nullptr;
  if constexpr (isLong)
    L = cholmod_l_analyze_p(&A, identity.data(), nullptr, 0, &common);
  else
    L = cholmod_analyze_p(&A, identity.data(), nullptr, 0, &common);
  std::optional<Supernodes> result;
  if (L != nullptr && L->is_super != 0) {
    const auto taken = [](const void* numbers, size_t count) {
      const auto* first = static_cast<const Index*>(numbers);
      return std::vector<int>(first, first + count);
    };
    result = {taken(L->Perm, A.nrow), taken(L->super, L->nsuper + 1), taken(L->pi, L->nsuper + 1),
              taken(L->s, L->ssize)};
  }
  if (isLong) {
    cholmod_l_free_factor(&L, &common);
    cholmod_l_finish(&common);
  } else {
    cholmod_free_factor(&L, &common);
    cholmod_finish(&common);
  }
  return result;
}

}  // namespace

Elimination analyse(const SparsePattern& pattern, const std::vector<int>& kept, bool aside) {
  Elimination result;
  result.size = pattern.size;
  result.kept = static_cast<int>(kept.size());
  if (pattern.size == 0) return result;
  const int interior = result.size - result.kept;

  const std::vector<int> order = fillReducingOrder(pattern, kept, aside);
  std::vector<int> position(result.size);
  for (int i = 0; i < result.size; ++i) position[order[i]] = i;

  // The kept equations couple as a clique, so they end up together in the last supernode.
  Columns columns = permuted(pattern, position, result.size, interior);
  std::optional<Supernodes> found = supernodesOf<int>(columns);
  if (!found) found = supernodesOf<SuiteSparse_long>(columns);  // factors of more than 2^31 numbers
  if (!found) throw std::runtime_error("symbolic analysis of the tangent failed in CHOLMOD");
  columns = {};
  const auto& [permutation, super, rowStart, rows] = *found;
  result.order.resize(result.size);
  for (int i = 0; i < result.size; ++i) {
    result.order[i] = order[permutation[i]];
    position[result.order[i]] = i;
  }
  for (int k = 0; k < result.kept; ++k)
    if (position[kept[k]] != interior + k)
      throw std::runtime_error("kept equations were moved by the analysis");

  const int fronts = static_cast<int>(super.size()) - 1;
  std::vector<int> frontOf(result.size);
  result.fronts.resize(fronts);
  for (int s = 0; s < fronts; ++s) {
    Front& front = result.fronts[s];
    front.rows.assign(rows.begin() + rowStart[s], rows.begin() + rowStart[s + 1]);
    front.pivots = std::min(super[s + 1], interior) - super[s];
    std::fill(frontOf.begin() + super[s], frontOf.begin() + super[s + 1], s);
  }
  if (super[fronts - 1] > interior) throw std::runtime_error("kept equations were not gathered in one front");

  std::vector<int> index(result.size);
  for (int s = 0; s < fronts; ++s) {
    Front& front = result.fronts[s];
    if (s == fronts - 1 || front.pivots == static_cast<int>(front.rows.size())) continue;
    front.parent = frontOf[front.rows[front.pivots]];
    result.fronts[front.parent].children.push_back(s);
    const Front& parent = result.fronts[front.parent];
    for (size_t i = 0; i < parent.rows.size(); ++i) index[parent.rows[i]] = static_cast<int>(i);
    front.inParent.reserve(front.updates());
    for (size_t i = front.pivots; i < front.rows.size(); ++i) front.inParent.push_back(index[front.rows[i]]);
  }

  // Every entry of the pattern is assembled where the first of its two positions is eliminated.
  std::vector<size_t> count(fronts + 1, 0);
  const auto forEachEntry = [&](auto visit) {
    for (int j = 0; j < pattern.size; ++j)
      for (int k = pattern.columnStart[j]; k < pattern.columnStart[j + 1]; ++k)
        visit(k, position[pattern.rows[k]], position[j],
              frontOf[std::min(position[pattern.rows[k]], position[j])]);
  };
  forEachEntry([&](int, int, int, int front) { ++count[front + 1]; });
  std::partial_sum(count.begin(), count.end(), count.begin());
  for (int s = 0; s < fronts; ++s) result.fronts[s].firstEntry = count[s];
  result.entries.resize(pattern.rows.size());
  result.positions.resize(pattern.rows.size());
  std::vector<size_t> next(count.begin(), count.end() - 1);
  std::vector<int> rowOf(pattern.rows.size());
  std::vector<int> columnOf(pattern.rows.size());
  forEachEntry([&](int entry, int row, int column, int front) {
    const size_t at = next[front]++;
    result.entries[at] = entry;
    rowOf[at] = pattern.symmetric ? std::max(row, column) : row;
    columnOf[at] = pattern.symmetric ? std::min(row, column) : column;
  });
  for (int s = 0; s < fronts; ++s) {
    const Front& front = result.fronts[s];
    for (size_t i = 0; i < front.rows.size(); ++i) index[front.rows[i]] = static_cast<int>(i);
    const size_t n = front.rows.size();
    const size_t pivots = front.pivots;
    const size_t upper = pattern.symmetric ? 0 : pivots * front.updates();
    for (size_t at = count[s]; at < count[s + 1]; ++at) {
      const size_t i = index[rowOf[at]];
      const size_t j = index[columnOf[at]];
      size_t place = 0;
      if (j < pivots)
        place = n * j + i;
      else if (i < pivots)
        place = front.panelSize() + front.updates() * i + (j - pivots);
      else
        place = front.panelSize() + upper + front.updates() * (j - pivots) + (i - pivots);
      if (place > std::numeric_limits<uint32_t>::max())
        throw std::runtime_error("a front of the tangent is too large");
      result.positions[at] = static_cast<uint32_t>(place);
    }
  }
  return result;
}

}  // namespace mortier
