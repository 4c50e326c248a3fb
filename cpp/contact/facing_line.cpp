#include "contact/facing_line.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>

#include "contact/element_tree.h"

namespace mortier {
namespace {

/// Lines face each other up to this angle between their directions: cos 60 degrees.
constexpr double facing = 0.5;
/// Abscissae closer to an end of the part than this part of the element there are on it.
constexpr double sameEnd = 1e-9;
/// Places on an element that differ by less are one.
constexpr double sameSight = 4e-16;

double cross(const Point& a, const Point& b) {
  return a.x() * b.y() - a.y() * b.x();
}

/// The point of the part that sees x.
struct Foot {
  double s = 0;
  Point normal = Point::Zero();
  double distance = std::numeric_limits<double>::infinity();  ///< infinite where no point does
};

Foot footOnStraight(const SmoothPart& part, const Point& x) {
  const Point& n = part.normals.front();
  const Point t(-n.y(), n.x());
  const Point from = x - part.points.front();
  return {from.dot(t), n, std::abs(from.dot(n))};
}

/// The direction of contact of two points that face each other.
Point directionOf(const Point& n1, double curvature1, const Point& n2, double curvature2, double smooth) {
  if (!(n1.dot(n2) < 0)) return n1;
  const double sum = curvature1 + curvature2;
  const double weight = smooth * (sum > 0 ? curvature1 / sum : 0.5);
  return ((1 - weight) * n1 - weight * n2).normalized();
}

/// A mortar node with its normal and curvature.
struct MortarNode {
  Point x;
  Point normal;
  double curvature = 0;
  double smooth = 1;
};

/// (x1 - x2) x n at a part xi of an element of the part; it falls along the part where the lines face each other.
double crossProduct(const SmoothPart& part, int element, double xi, const MortarNode& node) {
  const double s = part.s[element] + xi * (part.s[element + 1] - part.s[element]);
  const Point n = directionOf(part.normalAt(element, s), part.curvatureAt(element, s), node.normal,
                              node.curvature, node.smooth);
  return cross(part.points[element] + xi * (part.points[element + 1] - part.points[element]) - node.x, n);
}

/// Its root in [0, 1], between f0 >= 0 and f1 < 0, by false position (Illinois).
double rootIn(const SmoothPart& part, int element, const MortarNode& node, double f0, double f1) {
  double low = 0;
  double high = 1;
  int side = 0;
  for (int k = 0; k < 100 && f0 != 0; ++k) {
    const double xi = low + (high - low) * (f0 / (f0 - f1));
    if (!(xi > low && xi < high)) break;
    const double f = crossProduct(part, element, xi, node);
    (f >= 0 ? low : high) = xi;
    (f >= 0 ? f0 : f1) = f;
    if (f >= 0 && side == 1) f1 /= 2;
    if (f < 0 && side == -1) f0 /= 2;
    side = f >= 0 ? 1 : -1;
  }
  return f0 <= -f1 ? low : high;
}

Foot footOnCurve(const SmoothPart& part, const ElementTree& tree, const MortarNode& node) {
  Foot best;
  const auto consider = [&](double s, const Point& foot, const Point& normal) {
    const double distance = (foot - node.x).norm();
    if (distance < best.distance) best = {s, normal, distance};
  };
  const auto at = [&](int element, double xi) { return crossProduct(part, element, xi, node); };
  tree.near(node.x, best.distance, [&](int e) {
    const double f0 = at(e, 0);
    const double f1 = at(e, 1);
    if (!(f0 >= 0 && f1 < 0)) return;
    const double xi = rootIn(part, e, node, f0, f1);
    const double s = part.s[e] + xi * (part.s[e + 1] - part.s[e]);
    consider(s, part.at(e, s), part.normalAt(e, s));
  });
  if (part.closed) return best;
  const auto beyond = [&](int end, int element, double f) {
    const Point d = part.direction(element);
    const Point n =
        directionOf(part.normals[end], part.curvatures[end], node.normal, node.curvature, node.smooth);
    const double by = -f / cross(d, n);
    consider(part.s[end] + by, part.points[end] + by * d, part.normals[end]);
  };
  const int last = part.elements() - 1;
  if (const double f = at(0, 0); f < 0) beyond(0, 0, f);
  if (const double f = at(last, 1); f >= 0) beyond(last + 1, last, f);
  return best;
}

using Elements = std::unordered_map<int, FacingElement>;

/// Mortar nodes along the part with their feet.
struct Feet {
  std::vector<int> nodes;
  std::vector<Point> points;
  std::vector<Foot> feet;
};

Feet feetOf(const SmoothPart& part, const BoundaryLine& line, const Elements& elements) {
  Feet result{line.nodes, line.points, {}};
  const ElementTree tree(part.points);
  for (size_t j = 0; j < line.nodes.size(); ++j) {
    const Point& x = line.points[j];
    const int end = j + 1 < line.nodes.size() ? 0 : 1;  // of the element after the node, or of the last one
    const FacingElement& element = elements.at(line.nodes[j - end]);
    result.feet.push_back(
        part.straight ? footOnStraight(part, x)
                      : footOnCurve(part, tree,
                                    {x, element.normals[end], element.curvatures[end], element.smooth[end]}));
  }
  std::reverse(result.nodes.begin(), result.nodes.end());
  std::reverse(result.points.begin(), result.points.end());
  std::reverse(result.feet.begin(), result.feet.end());
  if (!part.closed) return result;
  // Unrolled: each turn round the part adds its length.
  const double length = part.length();
  for (size_t j = 1; j < result.feet.size(); ++j) {
    Foot& foot = result.feet[j];
    foot.s += length * std::round((result.feet[j - 1].s - foot.s) / length);
  }
  if (!line.closed) return result;
  // Begun before the part begins, and gone round until it ends.
  const auto n = static_cast<int>(result.nodes.size()) - 1;
  Feet around;
  for (int turn = -2; turn <= 2; ++turn)
    for (int j = 0; j < n; ++j) {
      Foot foot = result.feet[j];
      foot.s += turn * length;
      around.nodes.push_back(result.nodes[j]);
      around.points.push_back(result.points[j]);
      around.feet.push_back(foot);
    }
  const auto at = [&](size_t j) { return around.feet[j].s; };
  size_t begin = 0;
  while (begin + 1 < around.feet.size() && at(begin + 1) <= 0) ++begin;
  size_t end = begin;
  while (end + 1 < around.feet.size() && at(end) < length) ++end;
  const auto cut = [&](auto& list) {
    list.erase(list.begin() + static_cast<std::ptrdiff_t>(end) + 1, list.end());
    list.erase(list.begin(), list.begin() + static_cast<std::ptrdiff_t>(begin));
  };
  cut(around.nodes);
  cut(around.points);
  cut(around.feet);
  return around;
}

FacingLine facingStretch(const SmoothPart& part, const BoundaryLine& line, const Elements& elements) {
  const Feet all = feetOf(part, line, elements);
  const auto faces = [&](size_t j) {
    const Foot& a = all.feet[j];
    const Foot& b = all.feet[j + 1];
    if (!std::isfinite(a.distance) || !std::isfinite(b.distance) || !(b.s > a.s)) return false;
    const Point n = (a.normal + b.normal).normalized();
    const Point d = (all.points[j + 1] - all.points[j]).normalized();
    return Point(-n.y(), n.x()).dot(d) > facing;
  };
  size_t begin = 0;
  size_t end = 0;
  double nearest = std::numeric_limits<double>::infinity();
  for (size_t j = 0; j + 1 < all.nodes.size(); ++j) {
    if (!faces(j)) continue;
    const size_t first = j;
    double distance = all.feet[j].distance;
    for (; j + 1 < all.nodes.size() && faces(j); ++j) distance = std::min(distance, all.feet[j + 1].distance);
    const bool overlaps = all.feet[first].s < part.length() && all.feet[j].s > 0;
    if (overlaps && distance < nearest) {
      nearest = distance;
      begin = first;
      end = j;
    }
  }
  FacingLine stretch;
  if (begin == end) return stretch;
  for (size_t j = begin; j <= end; ++j) {
    stretch.nodes.push_back(all.nodes[j]);
    stretch.points.push_back(all.points[j]);
    stretch.s.push_back(all.feet[j].s);
    if (j == begin) continue;
    FacingElement element = elements.at(all.nodes[j]);  // from there as the mesh runs
    std::swap(element.normals[0], element.normals[1]);
    std::swap(element.curvatures[0], element.curvatures[1]);
    std::swap(element.smooth[0], element.smooth[1]);
    stretch.elements.push_back(element);
  }
  const double first = part.s[1] - part.s[0];
  const double last = part.s[part.s.size() - 1] - part.s[part.s.size() - 2];
  for (double& s : stretch.s) {
    if (std::abs(s) <= sameEnd * first) s = 0;
    if (std::abs(s - part.length()) <= sameEnd * last) s = part.length();
  }
  return stretch;
}

}  // namespace

MortarLine::MortarLine(BoundaryLine boundary) : line(std::move(boundary)) {
  const std::vector<SmoothPart> parts = smoothParts(line);
  for (size_t k = 0; k < parts.size(); ++k) {
    const SmoothPart& part = parts[k];
    const bool round = line.closed && parts.size() > 1;
    const bool cornerBefore = k > 0 || round;
    const bool cornerAfter = k + 1 < parts.size() || round;
    for (int e = 0; e < part.elements(); ++e)
      elements[part.nodes[e]] = {
          {part.normals[e], part.normals[e + 1]},
          {part.curvatures[e], part.curvatures[e + 1]},
          {e == 0 && cornerBefore ? 0.0 : 1.0, e + 1 == part.elements() && cornerAfter ? 0.0 : 1.0},
          part.arcs[e]};
  }
}

FacingLine facingLine(const SmoothPart& part, const MortarLine& mortar) {
  // A closed line is opened where it is farthest off.
  if (mortar.line.closed && !part.closed)
    return facingStretch(part, begunAt(mortar.line, farthestNode(mortar.line.points, part.points)),
                         mortar.elements);
  return facingStretch(part, mortar.line, mortar.elements);
}

Sight see(const SmoothPart& part, const FacingLine& mortar, const Segment& segment, double s) {
  const int e = segment.nonmortar;
  const Point& a = mortar.points[segment.mortar];
  const Point& b = mortar.points[segment.mortar + 1];
  const FacingElement& across = mortar.elements[segment.mortar];
  const Point x = part.at(e, s);
  Sight sight;
  sight.phi = hats(part.s, e, s);
  if (part.straight) {
    sight.normal = part.normals.front();
    sight.psi = hats(mortar.s, segment.mortar, s);
  } else {
    const Point n1 = part.normalAt(e, s);
    const double curvature1 = part.curvatureAt(e, s);
    const auto between = [](const auto& ends, double xi) { return (1 - xi) * ends[0] + xi * ends[1]; };
    // The direction depends on the point that is seen, hardly where the lines are close. Whatever is left of the
    // iteration, the point is on the line along the direction in the end.
    double seen = cross(x - a, n1) / cross(b - a, n1);
    for (int k = 0; k < 50; ++k) {
      const double xi = std::clamp(seen, 0.0, 1.0);
      const Point n2 = between(across.normals, xi);
      sight.normal = directionOf(n1, curvature1, n2.normalized(), between(across.curvatures, xi),
                                 between(across.smooth, xi));
      const double before = seen;
      seen = cross(x - a, sight.normal) / cross(b - a, sight.normal);
      if (std::abs(seen - before) <= sameSight) break;
    }
    sight.psi = {1 - seen, seen};
  }
  const Point y = sight.psi[0] * a + sight.psi[1] * b;
  sight.distance = (y - x).dot(sight.normal);
  if (part.arcs[e].known)
    sight.bulge += distanceToArc(part.points[e], part.points[e + 1], part.arcs[e].curvature, x, sight.normal);
  if (across.arc.known) sight.bulge += distanceToArc(b, a, across.arc.curvature, y, -sight.normal);
  return sight;
}

Segment placeOf(const SmoothPart& part, const FacingLine& mortar, int node) {
  const double s = std::clamp(part.s[node], mortar.s.front(), mortar.s.back());
  const auto above = std::upper_bound(mortar.s.begin() + 1, mortar.s.end() - 1, s);
  return {std::min(node, part.elements() - 1), static_cast<int>(above - mortar.s.begin()) - 1, s, s};
}

Point directionAt(const SmoothPart& part, const FacingLine& mortar, int node) {
  const double s = part.s[node];
  if (part.straight || mortar.empty() || s < mortar.s.front() || s > mortar.s.back())
    return part.normals[node];
  return see(part, mortar, placeOf(part, mortar, node), s).normal;
}

}  // namespace mortier
