#include "contact/interface_entries.h"

#include <algorithm>

#include "contact/row_functions.h"

namespace mortier {

std::vector<SmoothPart> partsFacing(const BoundaryLine& line, const BoundaryLine& mortar) {
  std::vector<SmoothPart> parts = smoothParts(line);
  if (!parts.front().closed || mortar.closed) return parts;
  return smoothParts(begunAt(line, farthestNode(line.points, mortar.points)));
}

std::vector<char> mergedNodes(const CommonRefinement& refinement, CouplingKind kind,
                              const InterfaceOptions& options) {
  const SmoothPart& part = refinement.part();
  std::vector<char> merged(part.nodes.size(), 0);
  if (!options.nonmortarHeld || part.closed || rowDegree(kind, part.degree()) < part.degree()) return merged;
  const auto direction = [&](int i) { return asSpacePoint(refinement.directionAt(i)); };
  const auto held = [&](int i) { return options.nonmortarHeld(part.nodes[i], direction(i)); };
  const auto facingHeld = [&](int i) {
    if (refinement.segments().empty() || !options.mortarHeld) return false;
    const auto& [facing, place] = refinement.facingOfNode(i);
    const auto holds = [&](int end) {
      return facing.psi[end] == 0 ||
             options.mortarHeld(refinement.mortar().nodes[place.mortar + end], direction(i));
    };
    return holds(0) && holds(1);
  };
  const int last = part.elements();
  for (const auto& [end, neighbour] : {std::pair<int, int>{0, 1}, {last, last - 1}})
    if (held(end) && !held(neighbour))
      merged[end] = kind != CouplingKind::interpolation || facingHeld(end) ? 1 : 0;
  return merged;
}

std::vector<char> symmetricEnds(const CommonRefinement& refinement, const InterfaceOptions& options) {
  const SmoothPart& part = refinement.part();
  std::vector<char> symmetric(part.nodes.size(), 0);
  constexpr double onTheAxis = 1e-12;  // as where normals are kept along it (smooth_part.cpp)
  for (const int end : {0, part.elements()}) {
    const Point n = refinement.directionAt(end);
    const bool onAxis = options.axisymmetric && std::abs(part.points[end].x()) <= onTheAxis * part.length();
    const bool held = options.nonmortarHeld && options.nonmortarHeld(part.nodes[end], {-n.y(), n.x(), 0});
    symmetric[end] = held || onAxis ? 1 : 0;
  }
  return symmetric;
}

void mergeCorners(const CommonRefinement& refinement, std::vector<int>& corners, std::vector<char>& merged) {
  for (const CornerContact& corner : refinement.corners()) {
    if (!corner.ofPart || !(corner.weight > atCorner) || merged[corner.vertex] != 0) continue;
    const int node = refinement.part().nodes[corner.vertex];
    if (std::find(corners.begin(), corners.end(), node) != corners.end())
      merged[corner.vertex] = 1;
    else
      corners.push_back(node);
  }
}

double unknownSagitta(const CommonRefinement& refinement) {
  const SmoothPart& part = refinement.part();
  const MortarLine& mortar = refinement.mortar();
  double largest = 0;
  for (const Segment& segment : refinement.segments()) {
    const auto consider = [&](const Arc& arc, const Point& a, const Point& b) {
      if (!arc.known) largest = std::max(largest, sagitta((b - a).norm(), arc.curvature));
    };
    const int i = segment.nonmortar;
    const int j = segment.mortar;
    if (!part.bent(i)) consider(part.arcs[i], part.points[i], part.points[i + 1]);
    if (!mortar.bent(j)) consider(mortar.geometry[j].arc, mortar.points[j], mortar.points[j + 1]);
  }
  return largest;
}

}  // namespace mortier
