#include "contact/facing_line.h"

#include <algorithm>
#include <cmath>
#include <limits>

namespace mortier {
namespace {

/// Lines face each other up to this angle between their directions: cos 60 degrees.
constexpr double facing = 0.5;
/// Abscissae closer to an end of the part than this part of the element there are on it.
constexpr double sameEnd = 1e-9;

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

/// The root in [0, 1] of (a + xi d - x) x (na + xi dn), which falls there from f0 >= 0 to f1 < 0.
double rootIn(const Point& a, const Point& d, const Point& na, const Point& dn, const Point& x, double f0,
              double f1) {
  const double c2 = cross(d, dn);
  const double c1 = cross(a - x, dn) + cross(d, na);
  const double discriminant = std::max(0.0, c1 * c1 - 4 * c2 * f0);
  // The falling root, without cancellation.
  const double root = std::sqrt(discriminant);
  double xi = c1 < 0 ? 2 * f0 / (root - c1) : (-c1 - root) / (2 * c2);
  if (!(xi >= 0 && xi <= 1)) xi = f0 / (f0 - f1);
  return std::clamp(xi, 0.0, 1.0);
}

Foot footOnCurve(const SmoothPart& part, const Point& x) {
  Foot best;
  const auto consider = [&](double s, const Point& foot, const Point& normal) {
    const double distance = (foot - x).norm();
    if (distance < best.distance) best = {s, normal, distance};
  };
  const int n = part.elements();
  double f0 = cross(part.points[0] - x, part.normals[0]);
  const double first = f0;
  for (int e = 0; e < n; ++e) {
    const double f1 = cross(part.points[e + 1] - x, part.normals[e + 1]);
    if (f0 >= 0 && f1 < 0) {
      const Point d = part.points[e + 1] - part.points[e];
      const Point dn = part.normals[e + 1] - part.normals[e];
      const double xi = rootIn(part.points[e], d, part.normals[e], dn, x, f0, f1);
      consider(part.s[e] + xi * (part.s[e + 1] - part.s[e]), part.points[e] + xi * d,
               (part.normals[e] + xi * dn).normalized());
    }
    f0 = f1;
  }
  if (part.closed) return best;
  const auto beyond = [&](int node, int element, double f) {
    const Point d = part.direction(element);
    const double by = -f / cross(d, part.normals[node]);
    consider(part.s[node] + by, part.points[node] + by * d, part.normals[node]);
  };
  if (first < 0) beyond(0, 0, first);
  if (f0 >= 0) beyond(n, n - 1, f0);
  return best;
}

/// The node of a closed line that is farthest from another line.
int farthestNode(const std::vector<Point>& line, const std::vector<Point>& other) {
  int farthest = 0;
  double distance = -1;
  for (size_t i = 0; i + 1 < line.size(); ++i) {
    double nearest = std::numeric_limits<double>::infinity();
    for (const Point& x : other) nearest = std::min(nearest, (x - line[i]).squaredNorm());
    if (nearest > distance) {
      distance = nearest;
      farthest = static_cast<int>(i);
    }
  }
  return farthest;
}

/// Mortar nodes along the part with their feet.
struct Feet {
  std::vector<int> nodes;
  std::vector<Point> points;
  std::vector<Foot> feet;
};

Feet feetOf(const SmoothPart& part, const BoundaryLine& line) {
  Feet result{line.nodes, line.points, {}};
  std::reverse(result.nodes.begin(), result.nodes.end());
  std::reverse(result.points.begin(), result.points.end());
  for (const Point& x : result.points)
    result.feet.push_back(part.straight ? footOnStraight(part, x) : footOnCurve(part, x));
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

}  // namespace

FacingLine facingLine(const SmoothPart& part, const BoundaryLine& mortar) {
  // A closed line is opened where it is farthest off.
  const bool around = part.closed && mortar.closed;
  if (mortar.closed && !around && farthestNode(mortar.points, part.points) != 0)
    return facingLine(part, begunAt(mortar, farthestNode(mortar.points, part.points)));
  const Feet all = feetOf(part, mortar);
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
  FacingLine line;
  if (begin == end) return line;
  for (size_t j = begin; j <= end; ++j) {
    line.nodes.push_back(all.nodes[j]);
    line.points.push_back(all.points[j]);
    line.s.push_back(all.feet[j].s);
  }
  const double first = part.s[1] - part.s[0];
  const double last = part.s[part.s.size() - 1] - part.s[part.s.size() - 2];
  for (double& s : line.s) {
    if (std::abs(s) <= sameEnd * first) s = 0;
    if (std::abs(s - part.length()) <= sameEnd * last) s = part.length();
  }
  return line;
}

Eigen::Vector2d mortarHats(const SmoothPart& part, const FacingLine& mortar, const Segment& segment,
                           double s) {
  if (part.straight) return hats(mortar.s, segment.mortar, s);
  const Point x = part.at(segment.nonmortar, s);
  const Point n = part.normalAt(segment.nonmortar, s);
  const Point& a = mortar.points[segment.mortar];
  const Point& b = mortar.points[segment.mortar + 1];
  const double fraction = cross(x - a, n) / cross(b - a, n);
  return {1 - fraction, fraction};
}

}  // namespace mortier
