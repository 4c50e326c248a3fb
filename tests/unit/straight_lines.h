// Two straight lines on each other, by the abscissae of their vertices.
#pragma once

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

inline FacingLine straightFacing(const Trace& trace, int degree = 1) {
  FacingLine line;
  setOnAxis(line, trace, degree);
  line.geometry.assign(trace.size() - 1, {{Point(0, 1), Point(0, 1)}, {}, {1, 1}, {0, true}});
  return line;
}

}  // namespace mortier
