#include "contact/facing_line.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <limits>
#include <unordered_map>

namespace mortier {
namespace {

/// Lines face each other up to this angle between their directions: cos 60 degrees.
constexpr double leastFacing = 0.5;
/// Abscissae closer to an end of the part than this part of the element there are on it.
constexpr double sameEdgeEnd = 1e-9;
/// Places on an element that differ by less are one.
constexpr double samePart = 4e-16;

/// The point of the part that faces x.
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

/// (x1 - x2) x n at a part xi of an element of the part;
/// it falls along the part where the lines face each other.
double crossProduct(const SmoothPart& part, int element, double xi, const MortarNode& node) {
  const double s = part.s[element] + xi * (part.s[element + 1] - part.s[element]);
  const Point n = directionOf(part.normalAt(element, s), part.curvatureAt(element, s), node.normal,
                              node.curvature, node.smooth);
  return cross(part.at(element, xi) - node.x, n);
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
  // Past the ends first: it bounds the search between them.
  const auto beyond = [&](int end, int element, double f) {
    const Point d = part.direction(element);
    const Point n =
        directionOf(part.normals[end], part.curvatures[end], node.normal, node.curvature, node.smooth);
    const double by = -f / cross(d, n);
    consider(part.s[end] + by, part.points[end] + by * d, part.normals[end]);
  };
  const int last = part.elements() - 1;
  if (const double f = at(0, 0); !part.closed && f < 0) beyond(0, 0, f);
  if (const double f = at(last, 1); !part.closed && f >= 0) beyond(last + 1, last, f);
  tree.near(node.x, best.distance, [&](int e) {
    const double f0 = at(e, 0);
    const double f1 = at(e, 1);
    if (!(f0 >= 0 && f1 < 0)) return;
    const double xi = rootIn(part, e, node, f0, f1);
    const double s = part.s[e] + xi * (part.s[e + 1] - part.s[e]);
    consider(s, part.at(e, xi), part.normalAt(e, s));
  });
  return best;
}

/// The stretch of the mortar line that faces a part, from its nearest element on in both directions.
class Search {
 public:
  Search(const SmoothPart& part, const MortarLine& mortar)
      : part_(part), mortar_(mortar), tree_(part.straight ? std::vector<Point>{} : part.points) {}

  FacingLine stretch() {
    const int seed = nearest();
    return seed < 0 ? FacingLine{} : around(seed);
  }

 private:
  /// A node of the mortar line; a closed one has them again and again.
  [[nodiscard]] int within(int node) const {
    const int n = mortar_.elements();
    return mortar_.closed ? (node % n + n) % n : node;
  }
  [[nodiscard]] bool has(int element) const {
    return mortar_.closed || (element >= 0 && element < mortar_.elements());
  }

  const Foot& footOf(int node) {
    node = within(node);
    const auto [found, isNew] = feet_.try_emplace(node);
    if (!isNew) return found->second;
    const Point& x = mortar_.points[node];
    const int end = node < mortar_.elements() ? 0 : 1;  // of the element after the node, or of the last one
    const FacingElement& element = mortar_.geometry[node - end];
    found->second =
        part_.straight ? footOnStraight(part_, x)
                       : footOnCurve(part_, tree_,
                                     {x, element.normals[end], element.curvatures[end], element.smooth[end]});
    return found->second;
  }

  /// Abscissa of a node next to one at `from`: each turn round a closed part adds its length.
  double abscissaOf(int node, double from) {
    const double s = footOf(node).s;
    return part_.closed ? s + part_.length() * std::round((from - s) / part_.length()) : s;
  }

  bool faces(int element) {
    const Foot a = footOf(element);
    const Foot b = footOf(element + 1);
    if (!std::isfinite(a.distance) || !std::isfinite(b.distance) || !(abscissaOf(element + 1, a.s) > a.s))
      return false;
    const Point n = (a.normal + b.normal).normalized();
    const Point d = (mortar_.points[within(element) + 1] - mortar_.points[within(element)]).normalized();
    return Point(-n.y(), n.x()).dot(d) > leastFacing;
  }

  /// The least distance of an element over the part, infinite where it is not over it.
  double distanceOf(int element) {
    const Foot a = footOf(element);
    const double to = abscissaOf(element + 1, a.s);
    const double begin = part_.closed ? a.s : std::max(a.s, 0.0);
    const double end = part_.closed ? to : std::min(to, part_.length());
    if (!(begin < end)) return std::numeric_limits<double>::infinity();
    const double slope = (footOf(element + 1).distance - a.distance) / (to - a.s);
    return a.distance + std::min(slope * (begin - a.s), slope * (end - a.s));
  }

  int nearest() {
    Eigen::AlignedBox2d box;
    for (const Point& x : part_.points) box.extend(x);
    int seed = -1;
    double distance = std::numeric_limits<double>::infinity();
    mortar_.tree.near(box.min(), box.max(), distance, [&](int element) {
      if (!faces(element)) return;
      const double here = distanceOf(element);
      if (here < distance) {
        distance = here;
        seed = element;
      }
    });
    return seed;
  }

  FacingLine around(int seed) {
    const int most = mortar_.elements();
    std::vector<double> before{footOf(seed).s};  // against the direction
    int first = seed;
    for (; before.back() > 0 && seed - first < most && has(first - 1) && faces(first - 1); --first)
      before.push_back(abscissaOf(first - 1, before.back()));
    FacingLine line;
    line.s.assign(before.rbegin(), before.rend());
    int last = seed;
    line.s.push_back(abscissaOf(seed + 1, line.s.back()));
    for (; line.s.back() < part_.length() && last - seed < most && has(last + 1) && faces(last + 1); ++last)
      line.s.push_back(abscissaOf(last + 2, line.s.back()));
    for (int node = first; node <= last + 1; ++node) {
      line.nodes.push_back(mortar_.nodes[within(node)]);
      line.points.push_back(mortar_.points[within(node)]);
      if (node == first) continue;
      const int element = within(node - 1);
      line.geometry.push_back(mortar_.geometry[element]);
      if (mortar_.middles.empty()) continue;
      line.middles.push_back(mortar_.middles[element]);
      line.middlePoints.push_back(mortar_.middlePoints[element]);
    }
    const double atFirst = part_.s[1] - part_.s[0];
    const double atLast = part_.s[part_.s.size() - 1] - part_.s[part_.s.size() - 2];
    for (double& s : line.s) {
      if (std::abs(s) <= sameEdgeEnd * atFirst) s = 0;
      if (std::abs(s - part_.length()) <= sameEdgeEnd * atLast) s = part_.length();
    }
    return line;
  }

  const SmoothPart& part_;
  const MortarLine& mortar_;
  ElementTree tree_;
  std::unordered_map<int, Foot> feet_;
};

/// The part of an element of the mortar line at which (y - x) x n = 0
double partFaced(const FacingLine& line, int element, const Point& x, const Point& n) {
  const Point& a = line.points[element];
  double xi = cross(x - a, n) / cross(line.points[element + 1] - a, n);
  if (!line.bent(element)) return xi;
  for (int k = 0; k < 20; ++k) {  // Newton's method
    const double by = cross(x - line.at(element, xi), n) / cross(line.tangentAt(element, xi), n);
    xi += by;
    if (std::abs(by) <= samePart) break;
  }
  return xi;
}

/// What the curve behind an element takes from the distance at a point x of it, along n: where the part has
/// moved that of the drawn one, which turns with the element.
double bulgeOf(const SmoothPart* drawn, int element, double xi, const Arc& arc,
               const std::array<Point, 2>& ends, const Point& x, const Point& n) {
  if (drawn == nullptr) return distanceTo(arc, ends[0], ends[1], x, n);
  if (drawn->straight) return 0;
  const Point& a = drawn->points[element];
  const Point& b = drawn->points[element + 1];
  const Point along = (ends[1] - ends[0]).normalized();
  const Point before = (b - a).normalized();
  const double cosine = along.dot(before);
  const double sine = cross(along, before);
  return distanceTo(arc, a, b, drawn->at(element, xi),
                    {cosine * n.x() - sine * n.y(), sine * n.x() + cosine * n.y()});
}

/// Of a node of the part: its element and its abscissa.
std::pair<int, double> placeOf(const SmoothPart& part, int node) {
  const auto vertices = static_cast<int>(part.nodes.size());
  if (node < vertices) return {std::min(node, part.elements() - 1), part.s[node]};
  const int element = node - vertices;
  return {element, (part.s[element] + part.s[element + 1]) / 2};
}

}  // namespace

MortarLine::MortarLine(const std::vector<SmoothPart>& parts, bool isClosed)
    : closed(isClosed), tree(std::vector<Point>{}) {
  for (size_t k = parts.size(); k-- > 0;) {
    const SmoothPart& part = parts[k];
    const bool round = closed && parts.size() > 1;
    const bool cornerBefore = k > 0 || round;
    const bool cornerAfter = k + 1 < parts.size() || round;
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
      geometry.push_back(
          {{part.normals[e + 1], part.normals[e]},
           {part.curvatures[e + 1], part.curvatures[e]},
           {e + 1 == part.elements() && cornerAfter ? 0.0 : 1.0, e == 0 && cornerBefore ? 0.0 : 1.0},
           part.arcs[e],
           part.drawn,
           e});
    }
  }
  tree = ElementTree(points);
}

FacingLine facingLine(const SmoothPart& part, const MortarLine& mortar) {
  return Search(part, mortar).stretch();
}

FacingPair facingPair(const SmoothPart& part, const FacingLine& mortar, const Segment& segment, double s) {
  const int e = segment.nonmortar;
  const int j = segment.mortar;
  const FacingElement& across = mortar.geometry[j];
  const double here = part.partAt(e, s);
  const Point x = part.at(e, here);
  FacingPair facing;
  double faced = 0;
  if (part.straight) {
    facing.normal = part.normals.front();
    faced = mortar.bent(j) ? partFaced(mortar, j, x, facing.normal) : mortar.partAt(j, s);
  } else {
    const Point n1 = part.normalAt(e, s);
    const double curvature1 = part.curvatureAt(e, s);
    const auto between = [](const auto& ends, double xi) { return (1 - xi) * ends[0] + xi * ends[1]; };
    // The direction depends on the point that is faced, hardly where the lines are close. Whatever is left of
    // the iteration, the point is on the line along the direction in the end.
    faced = partFaced(mortar, j, x, n1);
    for (int k = 0; k < 50; ++k) {
      const double xi = std::clamp(faced, 0.0, 1.0);
      const Point n2 = between(across.normals, xi).normalized();
      // At the end of a stretch rounding may turn the part away: its normal lies along the other line there.
      facing.normal = n1.dot(n2) < 0 ? directionOf(n1, curvature1, n2, between(across.curvatures, xi),
                                                   between(across.smooth, xi))
                                     : Point(-n2);
      const double before = faced;
      faced = partFaced(mortar, j, x, facing.normal);
      if (std::abs(faced - before) <= samePart) break;
    }
  }
  facing.phi = edgeShapes(part.degree(), here);
  facing.psi = edgeShapes(mortar.degree(), faced);
  const Point y = mortar.at(j, faced);
  facing.distance = (y - x).dot(facing.normal);
  if (part.bent(e)) facing.stretch = part.tangentAt(e, here).norm() / (part.s[e + 1] - part.s[e]);
  facing.bulge += bulgeOf(part.drawn.get(), e, here, part.arcs[e], {part.points[e], part.points[e + 1]}, x,
                          facing.normal);
  facing.bulge += bulgeOf(across.drawn.get(), across.inPart, 1 - faced, across.arc,
                          {mortar.points[j + 1], mortar.points[j]}, y, -facing.normal);
  return facing;
}

FacingNode facingOfNode(const SmoothPart& part, const FacingLine& mortar, int node) {
  const auto [element, s] = placeOf(part, node);
  // The element of the mortar line that holds s, the end elements beyond the ends.
  const auto after = std::upper_bound(mortar.s.begin() + 1, mortar.s.end() - 1, s);
  const Segment place{element, static_cast<int>(after - mortar.s.begin()) - 1, s, s};
  return {facingPair(part, mortar, place, s), place};
}

Point directionAt(const SmoothPart& part, const FacingLine& mortar, int node) {
  const auto [element, s] = placeOf(part, node);
  if (part.straight) return part.normals.front();
  if (mortar.empty() || s < mortar.s.front() || s > mortar.s.back()) return part.normalAt(element, s);
  return facingOfNode(part, mortar, node).facing.normal;
}

}  // namespace mortier
