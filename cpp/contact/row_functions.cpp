#include "contact/row_functions.h"

#include <algorithm>
#include <utility>

namespace mortier {

RowFunctions::RowFunctions(CouplingKind kind, const CommonRefinement& refinement,
                           const std::vector<char>& merged, const std::vector<char>& only)
    : part_(refinement.part()), degree_(rowDegree(kind, part_.degree())), ofNode_(part_.traceNodes(), -1) {
  if (refinement.empty()) return;
  const SmoothPart& part = part_;
  const auto last = static_cast<size_t>(part.elements());
  const auto facesBeside = [&](size_t i) {
    const auto faces = [&](size_t element) {
      const auto [from, to] = refinement.piecesOf(static_cast<int>(element));
      return from < to;
    };
    return (i > 0 ? faces(i - 1) : part.closed && faces(last - 1)) || (i < last && faces(i));
  };
  std::vector<char> faced(last + 1, 0);
  for (size_t i = 0; i <= last; ++i)
    // What the function of a row reaches to must face something.
    faced[i] = only.empty() ? refinement.faces(static_cast<int>(i)) : only[i] != 0 && facesBeside(i);
  // A mortar line between two vertices is the nearer one's.
  for (const Segment& piece : refinement.segments()) {
    const int e = piece.nonmortar;
    if (!only.empty() || !hasMeans(kind) || faced[e] != 0 || faced[e + 1] != 0) continue;
    const bool first = piece.begin + piece.end <= part.s[e] + part.s[e + 1];
    faced[first ? e : e + 1] = 1;
  }
  for (const CornerContact& corner : refinement.corners())
    if (corner.weight > atCorner && (only.empty() || only[corner.vertex] != 0)) faced[corner.vertex] = 1;
  const auto isMerged = [&](size_t i) {
    return !merged.empty() && merged[part.closed && i == last ? 0 : i] != 0;
  };
  const auto has = [&](size_t i) { return !isMerged(i) && faced[part.closed && i == last ? 0 : i] != 0; };
  // A value at a node in the middle does not need those at both ends.
  const auto middleFaces = [&](size_t e) {
    if (kind != CouplingKind::interpolation || isMerged(e) || isMerged(e + 1)) return false;
    const auto [from, to] = refinement.piecesOf(static_cast<int>(e));
    if (!only.empty()) return from < to && only[last + 1 + e] != 0;
    const double middle = (part.s[e] + part.s[e + 1]) / 2;
    return std::any_of(refinement.segments().begin() + from, refinement.segments().begin() + to,
                       [&](const Segment& piece) { return piece.begin <= middle && middle <= piece.end; });
  };
  const auto add = [&](size_t node) {
    ofNode_[node] = count();
    nodes_.push_back(static_cast<int>(node));
  };
  for (size_t i = 0; i <= last; ++i) {
    if (part.closed && i == last)
      ofNode_[i] = ofNode_[0];
    else if (has(i))
      add(i);
    if (degree_ == 2 && i < last && ((has(i) && has(i + 1)) || middleFaces(i))) add(last + 1 + i);
  }
}

EdgeNodes RowFunctions::at(int element) const {
  EdgeNodes rows = part_.nodesOf(element).head(degree_ + 1);
  for (int& row : rows) row = ofNode_[row];
  return rows;
}

EdgeValues RowFunctions::functions(int element, const EdgeNodes& rows, double s) const {
  if (rows[0] >= 0 && rows[1] >= 0) return edgeShapes(degree_, part_.partAt(element, s));
  if (rows.size() == 2 || rows[2] < 0) return EdgeValues::Unit(rows.size(), rows[0] < 0 ? 1 : 0);
  EdgeValues functions = edgeShapes(degree_, part_.partAt(element, s));
  for (int end = 0; end < 2; ++end)  // the middle has the part of an end without a row
    if (rows[end] < 0) functions[2] += std::exchange(functions[end], 0);
  return functions;
}

Vector lifted(const Vector& projected, const Vector& atNodes, const Vector& least) {
  const double by = std::max(0.0, (least.cwiseMin(atNodes) - projected).maxCoeff());
  return projected + (2 * (atNodes - projected)).cwiseMax(0).cwiseMin(by);
}

}  // namespace mortier
