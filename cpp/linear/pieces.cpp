#include <algorithm>

#include "linear/elimination.h"

namespace mortier {
namespace {

/// Multiplications in a front, about.
double workIn(const Front& front) {
  const auto n = static_cast<double>(front.rows.size());
  return front.pivots * n * n;
}

/// The most that is held at any time: what a front passes on is made in `workspace(front)` on top of that of
/// its children, then moved down over them (`passed(front)`).
template <class Size, class Workspace>
size_t stackOf(const std::vector<Front>& fronts, const Piece& piece, Size passed, Workspace workspace) {
  size_t stack = 0;
  size_t most = 0;
  std::vector<size_t> waiting;
  for (int s = piece.first; s <= piece.last; ++s) {
    most = std::max(most, stack + workspace(fronts[s]));
    for (size_t i = 0; i < fronts[s].children.size() && piece.children.empty(); ++i) {
      stack -= waiting.back();
      waiting.pop_back();
    }
    waiting.push_back(passed(fronts[s]));
    stack += waiting.back();
  }
  return most;
}

}  // namespace

Pieces cutIntoPieces(const std::vector<Front>& fronts) {
  // Small enough for threads to end together, large enough to be worth a lock.
  constexpr int parts = 128;
  constexpr double leastWork = 2e6;
  const auto n = static_cast<int>(fronts.size());
  std::vector<double> work(n);
  std::vector<int> firstBelow(n);
  double total = 0;
  for (int s = 0; s < n; ++s) {
    work[s] = workIn(fronts[s]);
    total += work[s];
    firstBelow[s] = s;
    for (const int child : fronts[s].children) {
      work[s] += work[child];
      firstBelow[s] = std::min(firstBelow[s], firstBelow[child]);
    }
  }
  const double limit = std::max(total / parts, leastWork);
  const auto isSmall = [&](int s) { return work[s] <= limit; };

  Pieces result;
  std::vector<int> pieceOf(n);
  double workInLast = 0;
  for (int s = 0; s < n; ++s) {
    const int parent = fronts[s].parent;
    if (isSmall(s) && parent >= 0 && isSmall(parent)) continue;
    Piece* last = result.all.empty() ? nullptr : &result.all.back();
    const bool joins = isSmall(s) && last != nullptr && isSmall(last->last) &&
                       fronts[last->last].parent == parent && workInLast + work[s] <= limit;
    if (joins) {
      last->last = s;
      workInLast += work[s];
    } else {
      Piece piece;
      piece.first = isSmall(s) ? firstBelow[s] : s;
      piece.last = s;
      result.all.push_back(std::move(piece));
      workInLast = work[s];
    }
    for (int i = firstBelow[s]; i <= s; ++i)
      if (isSmall(s) || i == s) pieceOf[i] = static_cast<int>(result.all.size()) - 1;
  }
  for (size_t p = 0; p < result.all.size(); ++p) {
    const int parent = fronts[result.all[p].last].parent;
    result.parent.push_back(parent < 0 ? -1 : pieceOf[parent]);
    if (parent >= 0) result.all[pieceOf[parent]].children.push_back(static_cast<int>(p));
  }
  const auto update = [](const Front& front) { return front.updates() * front.updates(); };
  const auto updatedRows = [](const Front& front) { return front.updates(); };
  const auto twoVectors = [](const Front& front) { return front.rows.size() + front.updates(); };
  for (Piece& piece : result.all) {
    piece.stack = stackOf(fronts, piece, update, update);
    piece.vectorStack = stackOf(fronts, piece, updatedRows, twoVectors);
  }
  return result;
}

}  // namespace mortier
