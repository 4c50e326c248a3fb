#include "contact/mortar_line.h"

#include <algorithm>
#include <cmath>

namespace mortier {
namespace {

/// Places on an element that differ by less are one.
constexpr double sameFacedPart = 4e-16;
/// So do distances by this part of an element: coordinates may be rounded.
constexpr double sameDistance = 1e-9;
/// A direction that makes more than 75 degrees with the normal of a side is no direction of contact there.
constexpr double leastCosine = 0.25;

}  // namespace

MortarLine::MortarLine(const std::vector<SmoothPart>& parts, bool isClosed)
    : closed(isClosed), tree(std::vector<Point>{}) {
  for (size_t k = parts.size(); k-- > 0;) {
    const SmoothPart& part = parts[k];
    const bool round = closed && !part.closed;
    const SmoothPart* before = k > 0 ? &parts[k - 1] : round ? &parts.back() : nullptr;
    const SmoothPart* after = k + 1 < parts.size() ? &parts[k + 1] : round ? &parts.front() : nullptr;
    const std::array<Point, 2> behindCorner = {after != nullptr ? after->normals.front() : Point::Zero(),
                                               before != nullptr ? before->normals.back() : Point::Zero()};
    if (nodes.empty()) {
      nodes.push_back(part.nodes.back());
      points.push_back(part.points.back());
    }
    for (int e = part.elements() - 1; e >= 0; --e) {
      nodes.push_back(part.nodes[e]);
      points.push_back(part.points[e]);
      if (!part.middles.empty()) {
        middles.push_back(part.middles[e]);
        middlePoints.push_back(part.middlePoints[e]);
      }
      geometry.push_back({{part.normals[e + 1], part.normals[e]},
                          {part.curvatures[e + 1], part.curvatures[e]},
                          {after != nullptr ? part.length() - part.s[e + 1] : infinity,
                           before != nullptr ? part.s[e] : infinity},
                          behindCorner,
                          part.arcs[e],
                          part.drawn,
                          static_cast<int>(k),
                          e});
    }
  }
  tree = ElementTree(points);
}

LineHit MortarLine::along(const Point& x, const Point& n) const {
  struct Passage {
    LineHit hit;
    bool faces = false;
    double cosine = 0;  ///< between the line and the normal of n
    double same = 0;    ///< distances that differ by less are one [m]
  };
  // Where several elements meet on the ray it is that which n is most nearly normal to.
  const auto isNearer = [](const Passage& one, const Passage& two) {
    const double by = std::abs(two.hit.distance) - std::abs(one.hit.distance);
    return std::abs(by) > std::max(one.same, two.same) ? by > 0 : one.cosine > two.cosine;
  };
  std::array<Passage, 2> nearest;  // ahead and behind
  double bound = infinity;
  const auto visit = [&](int j) {
    // The product is positive for a point behind on the line; of an element that faces x the first end is.
    const Point side = points[j + 1] - points[j];
    const double length = side.norm();
    const double from = cross(points[j] - x, n);
    const double to = cross(points[j + 1] - x, n);
    const double rounding = sameDistance * length;  // both elements at a node face what faces the node
    const bool faces = from > to && from >= -rounding && to <= rounding;
    if (!faces && !(from < 0 && to >= 0)) return;
    const double xi = partAlong(j, x, n);
    const Passage passage{{j, xi, (at(j, xi) - x).dot(n)}, faces, turned(n).dot(side) / length, rounding};
    Passage& best = nearest[passage.hit.distance < 0 ? 1 : 0];
    if (best.hit.found() && !isNearer(passage, best)) return;
    best = passage;
    bound = infinity;
    for (const Passage& each : nearest)
      if (each.faces) bound = std::min(bound, std::abs(each.hit.distance) + each.same);
  };
  tree.near(x, bound, visit,
            [&](const Point& low, const Point& high) { return sideOfLine(low, high, x, n) == 0; });
  const Passage* result = nullptr;
  for (const Passage& each : nearest)
    if (each.faces && (result == nullptr || isNearer(each, *result))) result = &each;
  return result != nullptr ? result->hit : LineHit{};
}

LineHit MortarLine::nearestTo(const Point& x, const Point& n) const {
  LineHit nearest;
  tree.near(x, nearest.distance, [&](int j) {
    const Point side = points[j + 1] - points[j];
    const double xi = std::clamp((x - points[j]).dot(side) / side.squaredNorm(), 0.0, 1.0);
    const double distance = (at(j, xi) - x).norm();
    if (distance < nearest.distance && mayFace(j, xi, n)) nearest = {j, xi, distance};
  });
  return nearest;
}

bool MortarLine::mayFace(int element, double xi, const Point& n) const {
  return n.dot(normalAt(element, xi)) < -leastCosine;
}

double MortarLine::partAlong(int element, const Point& x, const Point& n) const {
  const Point& a = points[element];
  double xi = cross(x - a, n) / cross(points[element + 1] - a, n);
  if (!bent(element)) return xi;
  for (int k = 0; k < 20; ++k) {  // Newton's method
    const double by = cross(x - at(element, xi), n) / cross(tangentAt(element, xi), n);
    xi += by;
    if (std::abs(by) <= sameFacedPart) break;
  }
  return xi;
}

Point MortarLine::normalAt(int element, double xi) const {
  const double part = std::clamp(xi, 0.0, 1.0);
  const auto& [a, b] = geometry[element].normals;
  return ((1 - part) * a + part * b).normalized();
}

double MortarLine::curvatureAt(int element, double xi) const {
  const double part = std::clamp(xi, 0.0, 1.0);
  const auto& [a, b] = geometry[element].curvatures;
  return (1 - part) * a + part * b;
}

double MortarLine::toCorner(int element, double xi) const {
  const double part = std::clamp(xi, 0.0, 1.0);
  const double length = (points[element + 1] - points[element]).norm();
  const auto& [a, b] = geometry[element].toCorner;
  return std::min(a + part * length, b + (1 - part) * length);
}

double MortarLine::toCorner(int element, double xi, const Point& n) const {
  const double part = std::clamp(xi, 0.0, 1.0);
  const double length = (points[element + 1] - points[element]).norm();
  const MortarElement& here = geometry[element];
  const auto from = [&](size_t end, double toEnd) {
    const double facing = std::clamp(-n.dot(here.behindCorner[end]) / leastCosine - 1, 0.0, 1.0);
    return facing > 0 ? (here.toCorner[end] + toEnd) / facing : infinity;
  };
  return std::min(from(0, part * length), from(1, (1 - part) * length));
}

}  // namespace mortier
