#include "contact/row_functions.h"

#include <algorithm>

namespace mortier {
namespace {

/// Takes from the vertices `first` to `last` of a part those that are one to the mortar trace.
/// \param stiffness  of the nonmortar over that of the mortar body
std::vector<char> dropped(const CommonRefinement& refinement, size_t first, size_t last, double stiffness) {
  constexpr double alike = 1e-9;  // distances that differ by rounding
  const SmoothPart& part = refinement.part();
  std::vector<char> drop(part.s.size(), 0);
  const Trace nodes = refinement.mortarNodes();
  if (last < first + 2 || nodes.size() < 2) return drop;
  const auto spacing = [&](double s) {
    const auto k = std::upper_bound(nodes.begin() + 1, nodes.end() - 1, s);
    return *k - *(k - 1);
  };
  for (size_t i = first + 1; i < last; ++i)
    drop[i] = stiffness * spacing(part.s[i]) > (1 + alike) * (part.s[i + 1] - part.s[i - 1]) / 2 ? 1 : 0;
  for (const double t : nodes) {
    const auto above = std::lower_bound(part.s.begin() + static_cast<std::ptrdiff_t>(first),
                                        part.s.begin() + static_cast<std::ptrdiff_t>(last), t);
    auto i = std::max<size_t>(above - part.s.begin(), first + 1);
    const double half = spacing(t) / 2;
    if (t - part.s[first] < half || part.s[last] - t < half) continue;
    if (t - part.s[i - 1] <= part.s[i] - t + alike * half) --i;
    drop[i] = 0;
  }
  return drop;
}

}  // namespace

RowFunctions::RowFunctions(CouplingKind kind, const CommonRefinement& refinement,
                           const std::vector<char>& merged, double stiffness, const std::vector<char>& only)
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
  const auto has = [&](size_t i) {
    const size_t own = part.closed && i == last ? 0 : i;
    return (merged.empty() || merged[own] == 0) && faced[own] != 0;
  };
  const auto add = [&](size_t node) {
    ofNode_[node] = count();
    nodes_.push_back(static_cast<int>(node));
  };
  if (kind == CouplingKind::coarsened) {
    size_t first = 0;
    size_t end = last + 1;
    while (first < end && !has(first)) ++first;
    while (end > first && !has(end - 1)) --end;
    if (first == end) return;
    std::vector<char> drop =
        only.empty() ? dropped(refinement, first, end - 1, stiffness) : std::vector<char>(part.s.size(), 0);
    for (const CornerContact& corner : refinement.corners()) drop[corner.vertex] = 0;
    for (size_t i = first; i < end; ++i)
      if (part.closed && i == last)
        ofNode_[i] = ofNode_[0];
      else if (drop[i] == 0 && has(i))
        add(i);
    findSpans();
    return;
  }
  for (size_t i = 0; i <= last; ++i) {
    if (part.closed && i == last)
      ofNode_[i] = ofNode_[0];
    else if (has(i))
      add(i);
    if (degree_ == 2 && i < last && has(i) && has(i + 1)) add(last + 1 + i);
  }
}

EdgeNodes RowFunctions::at(int element) const {
  EdgeNodes rows = spans_.empty() ? EdgeNodes(part_.nodesOf(element).head(degree_ + 1)) : spanOf(element);
  for (int& row : rows) row = ofNode_[row];
  return rows;
}

EdgeValues RowFunctions::functions(int element, const EdgeNodes& rows, double s) const {
  if (rows[0] < 0 || rows[1] < 0) return EdgeValues::Unit(rows.size(), rows[0] < 0 ? 1 : 0);
  if (spans_.empty()) return edgeShapes(degree_, part_.partAt(element, s));
  const auto& [begin, end] = spans_[element];
  return edgeShapes(1, (s - part_.s[begin]) / (part_.s[end] - part_.s[begin]));
}

std::vector<NodeBetween> RowFunctions::between() const {
  std::vector<NodeBetween> nodes;
  for (int e = 0; e < static_cast<int>(spans_.size()); ++e) {
    const EdgeNodes rows = at(e);
    if (rows.minCoeff() < 0) continue;
    const EdgeNodes of = part_.nodesOf(e);
    for (int k = 1; k <= part_.degree(); ++k)  // the first one is another element's
      if (ofNode_[of[k]] < 0) nodes.push_back({of[k], {rows[0], rows[1]}});
  }
  return nodes;
}

/// Finds the vertices with a row that are next to each element.
void RowFunctions::findSpans() {
  const int elements = part_.elements();
  spans_.assign(elements, {0, elements});
  for (int e = 0, at = 0; e < elements; ++e) spans_[e][0] = at = ofNode_[e] >= 0 ? e : at;
  for (int e = elements, at = elements; e-- > 0;) spans_[e][1] = at = ofNode_[e + 1] >= 0 ? e + 1 : at;
}

EdgeNodes RowFunctions::spanOf(int element) const {
  return EdgeNodes{{spans_[element][0], spans_[element][1]}};
}

}  // namespace mortier
