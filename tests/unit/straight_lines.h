// Two straight lines on each other, by the abscissae of their vertices.
#pragma once

#include <algorithm>

#include "contact/coupling.h"

namespace mortier {

/// Vertices on the x axis, then the middles of the elements.
inline void setOnAxis(ElementLine& line, const Trace& trace, int degree) {
  line.s = trace;
  const auto count = static_cast<int>(trace.size());
  for (int i = 0; i < count; ++i) {
    line.nodes.push_back(i);
    line.points.emplace_back(trace[i], 0);
  }
  for (int e = 0; degree == 2 && e + 1 < count; ++e) {
    line.middles.push_back(count + e);
    line.middlePoints.emplace_back((line.points[e] + line.points[e + 1]) / 2);
  }
}

/// The body lies above.
inline SmoothPart straightPart(const Trace& trace, int degree = 1) {
  SmoothPart part;
  setOnAxis(part, trace, degree);
  part.normals.assign(trace.size(), {0, -1});
  part.curvatures.assign(trace.size(), 0);
  part.arcs.assign(trace.size() - 1, {0, true});
  part.straight = true;
  return part;
}

/// The same of a body below, which runs against it.
inline SmoothPart straightPartBelow(const Trace& trace, int degree = 1) {
  const SmoothPart above = straightPart(trace, degree);
  SmoothPart part = above;
  for (const auto reverse : {&SmoothPart::nodes, &SmoothPart::middles})
    std::reverse((part.*reverse).begin(), (part.*reverse).end());
  for (const auto reverse : {&SmoothPart::points, &SmoothPart::middlePoints})
    std::reverse((part.*reverse).begin(), (part.*reverse).end());
  for (size_t i = 0; i < trace.size(); ++i) part.s[i] = trace.back() - trace[trace.size() - 1 - i];
  part.normals.assign(trace.size(), {0, 1});
  return part;
}

struct StraightLines {
  StraightLines(const Trace& nonmortar, const Trace& mortarTrace, int degree = 1)
      : part(straightPart(nonmortar, degree)),
        mortar({straightPartBelow(mortarTrace, degree)}, false),
        refinement(part, mortar) {}
  StraightLines(const StraightLines&) = delete;  // the refinement refers to the lines
  StraightLines& operator=(const StraightLines&) = delete;

  SmoothPart part;
  MortarLine mortar;
  CommonRefinement refinement;
};

}  // namespace mortier
