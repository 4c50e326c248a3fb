#include "linear/elimination.h"

#include <algorithm>
#include <limits>
#include <numeric>
#include <optional>
#include <stdexcept>
#include <type_traits>

#include "base/interrupt.h"
#include "linear/cholmod_common.h"
#include "linear/supervariables.h"

namespace mortier {
namespace {

/// Of a factor: the order, and of each supernode its first column and rows.
struct Supernodes {
  std::vector<int> permutation, super, rowStart, rows;
};

/// \param Index  of CHOLMOD's numbers. \param equationsOfAColumn  about
/// \returns nothing where the numbers do not suffice
template <class Index>
std::optional<Supernodes> supernodesOf(Columns& columns, int equationsOfAColumn) {
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
  common.nrelax[0] = std::max(2 / equationsOfAColumn, 1);
  common.nrelax[1] = 8 / equationsOfAColumn;
  common.nrelax[2] = 24 / equationsOfAColumn;
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

Elimination analyse(const SparsePattern& pattern, const std::vector<int>& kept) {
  Elimination result;
  result.size = pattern.size;
  result.kept = static_cast<int>(kept.size());
  if (pattern.size == 0) return result;

  const Supervariables supervariables(pattern, kept);
  const auto keptRuns = static_cast<int>(supervariables.kept.size());
  const int size = supervariables.pattern.size;
  const int interior = size - keptRuns;
  const std::vector<int> order = orderOfSupervariables(supervariables, pattern);
  stopIfInterrupted();
  std::vector<int> position(result.size);
  for (int i = 0; i < size; ++i) position[order[i]] = i;

  // The kept equations couple as a clique, so they end up together in the last supernode.
  Columns columns = permuted(supervariables.pattern, position, size, interior);
  const int equationsOfARun = (result.size + size / 2) / size;
  std::optional<Supernodes> found = supernodesOf<int>(columns, equationsOfARun);
  if (!found)  // factors of more than 2^31 numbers
    found = supernodesOf<SuiteSparse_long>(columns, equationsOfARun);
  if (!found) throw std::runtime_error("symbolic analysis of the tangent failed in CHOLMOD");
  columns = {};
  stopIfInterrupted();
  const auto& [permutation, super, rowStart, rows] = *found;
  std::vector<int> firstOf{0};  // position of the first equation of each run
  for (int i = 0; i < size; ++i) {
    const int run = order[permutation[i]];
    for (int equation = supervariables.first[run]; equation < supervariables.first[run + 1]; ++equation) {
      position[equation] = static_cast<int>(result.order.size());
      result.order.push_back(equation);
    }
    firstOf.push_back(static_cast<int>(result.order.size()));
  }
  for (int k = 0; k < result.kept; ++k)
    if (position[kept[k]] != result.size - result.kept + k)
      throw std::runtime_error("kept equations were moved by the analysis");

  const int fronts = static_cast<int>(super.size()) - 1;
  std::vector<int> frontOf(result.size);
  result.fronts.resize(fronts);
  for (int s = 0; s < fronts; ++s) {
    Front& front = result.fronts[s];
    for (int k = rowStart[s]; k < rowStart[s + 1]; ++k)
      for (int row = firstOf[rows[k]]; row < firstOf[rows[k] + 1]; ++row) front.rows.push_back(row);
    front.pivots = firstOf[std::min(super[s + 1], interior)] - firstOf[super[s]];
    std::fill(frontOf.begin() + firstOf[super[s]], frontOf.begin() + firstOf[super[s + 1]], s);
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

  stopIfInterrupted();
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
