#include "contact/common_refinement.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>

#include "contact/false_position.h"

namespace mortier {
namespace {

/// Elements face each other up to this angle between their directions: cos 60 degrees.
constexpr double leastFacing = 0.5;
/// Coordinates may be rounded: so much of an element past the end of the mortar line a vertex faces it.
constexpr double atEnd = 1e-6;
/// Places on an element that differ by less are one.
constexpr double negligiblePart = 1e-14;

/// Where rays of a nonmortar element cross a mortar element, by parts of the first.
struct Crossing {
  int mortar;
  double begin, end;
  bool faces;  ///< whether they face each other: else it hides what is behind it
};

/// What pieces of an element leave free of [0, 1].
class FreeParts {
 public:
  void take(double begin, double end) {
    std::vector<std::array<double, 2>> free;
    for (const auto& [a, b] : free_)
      for (const auto& [from, to] : {std::array{a, std::min(b, begin)}, std::array{std::max(a, end), b}})
        if (to - from > negligiblePart) free.push_back({from, to});
    free_ = std::move(free);
  }
  [[nodiscard]] bool none() const { return free_.empty(); }

 private:
  std::vector<std::array<double, 2>> free_{{0, 1}};
};

/// How far the curve behind an element is from a point x of it, along n: where the part has moved, that of
/// the drawn one, which turns with the element.
double curvatureCorrection(const SmoothPart* drawn, int element, double xi, const Arc& arc,
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

}  // namespace

CommonRefinement::CommonRefinement(const SmoothPart& part) : part_(&part), directions_{part.normals, {}, {}} {
  firstPiece_.assign(part.elements() + 1, 0);
}

CommonRefinement::CommonRefinement(const SmoothPart& part, const MortarLine& mortar,
                                   std::optional<double> mortarShare, const ContactDirections* kept)
    : part_(&part), mortar_(&mortar), directions_(contactDirections(part, mortar, mortarShare, kept)) {
  for (int e = 0; e < part.elements(); ++e) {
    refine(e);
    firstPiece_.push_back(static_cast<int>(segments_.size()));
  }
  findVertices();
}

Point CommonRefinement::ray(int element, double xi) const {
  return between(directions_.n, element, xi);
}

void CommonRefinement::refine(int element) {
  const SmoothPart& part = *part_;
  const MortarLine& mortar = *mortar_;
  const auto product = [&](int node, double xi) {
    return cross(mortar.points[node] - part.at(element, xi), ray(element, xi));
  };
  const auto distanceAt = [&](int j, double xi) {
    const Point x = part.at(element, xi);
    const Point n = ray(element, xi);
    return (mortar.at(j, mortar.partAlong(j, x, n)) - x).dot(n) / n.norm();
  };
  const Point direction = part.direction(element);
  // Where a mortar node is faced from: of the element before from `begin` on, of that after it to `end`.
  const auto sideOf = [&](int node, bool behind) -> std::array<double, 2> {
    const double f0 = product(node, 0);
    const double f1 = product(node, 1);
    const auto holds = [behind](double f) { return (f >= 0) == behind; };
    if (holds(f0) && holds(f1)) return {0, 1};
    if (!holds(f0) && !holds(f1)) return {1, 0};
    const double root = rootOf([&](double xi) { return product(node, xi); }, f0, f1);
    return holds(f1) ? std::array{root, 1.0} : std::array{0.0, root};
  };
  const Eigen::AlignedBox2d box = [&] {
    Eigen::AlignedBox2d around(part.points[element]);
    return around.extend(part.points[element + 1]);
  }();
  std::vector<Crossing> pieces;
  double bound = infinity;
  FreeParts free;
  const auto visit = [&](int j) {
    const double cosine = direction.dot(mortar.direction(j));
    const auto [afterBegin, afterEnd] = sideOf(j, cosine > 0);
    const auto [beforeBegin, beforeEnd] = sideOf(j + 1, !(cosine > 0));
    const Crossing piece{j, std::max(afterBegin, beforeBegin), std::min(afterEnd, beforeEnd),
                         cosine > leastFacing};
    if (!(piece.end - piece.begin > negligiblePart)) return;
    pieces.push_back(piece);
    if (piece.faces) free.take(piece.begin, piece.end);
    if (!free.none()) return;
    bound = 0;
    for (const Crossing& each : pieces)
      for (const double xi : {each.begin, each.end})
        if (each.faces) bound = std::max(bound, std::abs(distanceAt(each.mortar, xi)));
  };
  // Elements between which and the rays of both ends nothing lies are faced by none between them.
  mortar.tree.near(box.min(), box.max(), bound, visit, [&](const Point& low, const Point& high) {
    const int first = sideOfLine(low, high, part.points[element], ray(element, 0));
    return first == 0 || first != sideOfLine(low, high, part.points[element + 1], ray(element, 1));
  });
  if (pieces.empty()) return;
  std::vector<double> cuts;
  for (const Crossing& piece : pieces) cuts.insert(cuts.end(), {piece.begin, piece.end});
  std::sort(cuts.begin(), cuts.end());
  const double s0 = part.s[element];
  const double s1 = part.s[element + 1];
  const auto abscissa = [&](double xi) { return xi == 1 ? s1 : s0 + xi * (s1 - s0); };
  for (size_t k = 1; k < cuts.size(); ++k) {
    if (!(cuts[k] - cuts[k - 1] > negligiblePart)) continue;
    const double middle = (cuts[k - 1] + cuts[k]) / 2;
    struct Nearest {
      double distance = infinity;
      int mortar = -1;
      bool faces = false;
    };
    std::array<Nearest, 2> sides;  // ahead and behind
    for (const Crossing& piece : pieces) {
      if (!(piece.begin < middle && middle < piece.end)) continue;
      const double distance = distanceAt(piece.mortar, middle);
      Nearest& side = sides[distance < 0 ? 1 : 0];
      if (std::abs(distance) < side.distance) side = {std::abs(distance), piece.mortar, piece.faces};
    }
    const bool behind = sides[1].faces && !(sides[0].faces && sides[0].distance <= sides[1].distance);
    const int nearest = behind ? sides[1].mortar : sides[0].faces ? sides[0].mortar : -1;
    if (nearest < 0) continue;
    const double begin = abscissa(cuts[k - 1]);
    Segment* last = segments_.empty() ? nullptr : &segments_.back();
    if (last != nullptr && last->nonmortar == element && last->mortar == nearest && last->end == begin)
      last->end = abscissa(cuts[k]);
    else
      segments_.push_back({element, nearest, begin, abscissa(cuts[k])});
  }
}

void CommonRefinement::findVertices() {
  const SmoothPart& part = *part_;
  pieceAt_.assign(part.nodes.size(), -1);
  for (int k = static_cast<int>(segments_.size()) - 1; k >= 0; --k) {
    const Segment& segment = segments_[k];
    const int e = segment.nonmortar;
    const double near = atEnd * (part.s[e + 1] - part.s[e]);
    if (segment.end >= part.s[e + 1] - near && pieceAt_[e + 1] < 0) pieceAt_[e + 1] = k;
    if (segment.begin <= part.s[e] + near) pieceAt_[e] = k;
  }
  if (!part.closed) return;
  int& first = pieceAt_.front();
  int& last = pieceAt_.back();
  if (first < 0) first = last;
  last = first;
}

double CommonRefinement::length() const {
  double length = 0;
  for (const Segment& segment : segments_) length += segment.end - segment.begin;
  return length;
}

FacingPair CommonRefinement::pairAt(const Segment& segment, double s) const {
  const int e = segment.nonmortar;
  const int j = segment.mortar;
  const SmoothPart& part = *part_;
  const MortarElement& across = mortar_->geometry[j];
  const double here = part.partAt(e, s);
  const Point x = part.at(e, here);
  FacingPair facing;
  facing.normal = ray(e, here).normalized();
  const double faced = mortar_->partAlong(j, x, facing.normal);
  facing.phi = edgeShapes(part.degree(), here);
  facing.psi = edgeShapes(mortar_->degree(), faced);
  const Point y = mortar_->at(j, faced);
  facing.distance = (y - x).dot(facing.normal);
  if (part.bent(e)) facing.stretch = part.tangentAt(e, here).norm() / (part.s[e + 1] - part.s[e]);
  facing.curvatureCorrection += curvatureCorrection(part.drawn.get(), e, here, part.arcs[e],
                                                    {part.points[e], part.points[e + 1]}, x, facing.normal);
  facing.curvatureCorrection +=
      curvatureCorrection(across.drawn.get(), across.inPart, 1 - faced, across.arc,
                          {mortar_->points[j + 1], mortar_->points[j]}, y, -facing.normal);
  return facing;
}

namespace {

/// Of a node of the part: its element and its abscissa.
std::pair<int, double> placeOf(const SmoothPart& part, int node) {
  const auto count = static_cast<int>(part.nodes.size());
  if (node < count) return {std::min(node, part.elements() - 1), part.s[node]};
  const int element = node - count;
  return {element, (part.s[element] + part.s[element + 1]) / 2};
}

}  // namespace

FacingNode CommonRefinement::facingOfNode(int node) const {
  const SmoothPart& part = *part_;
  if (node < static_cast<int>(part.nodes.size()) && faces(node)) {
    const Segment& piece = segments_[pieceAt_[node]];
    const int e = piece.nonmortar;
    const double s = part.nodes[e] == part.nodes[node] ? part.s[e] : part.s[e + 1];
    const Segment place{e, piece.mortar, s, s};
    return {pairAt(place, s), place};
  }
  for (const CornerContact& corner : directions_.corners)
    if (corner.vertex == node) {
      const Segment place{corner.nonmortar, corner.mortar, corner.s, corner.s};
      return {pairAt(place, corner.s), place};
    }
  const auto [element, s] = placeOf(part, node);
  const auto [first, last] = piecesOf(element);
  const auto begin = segments_.begin() + (first < last ? first : 0);
  const auto end = first < last ? segments_.begin() + last : segments_.end();
  const auto off = [at = s](const Segment& piece) { return std::max(piece.begin - at, at - piece.end); };
  const auto nearest = std::min_element(
      begin, end, [&](const Segment& one, const Segment& two) { return off(one) < off(two); });
  const Segment place{nearest->nonmortar, nearest->mortar, s, s};
  return {pairAt(place, s), place};
}

Point CommonRefinement::directionAt(int node) const {
  const auto count = static_cast<int>(part_->nodes.size());
  return node < count ? directions_.n[node] : Point(ray(node - count, 0.5).normalized());
}

Trace CommonRefinement::mortarNodes() const {
  Trace nodes;
  const bool quadratic = mortar_ != nullptr && mortar_->degree() == 2;
  for (size_t k = 0; k < segments_.size();) {
    size_t last = k;
    while (last + 1 < segments_.size() && segments_[last + 1].mortar == segments_[k].mortar) ++last;
    const Segment& from = segments_[k];
    const Segment& to = segments_[last];
    const auto part = [&](const Segment& segment, double s) {
      const FacingPair facing = pairAt(segment, s);
      return facing.psi.size() > 2 ? facing.psi[1] + facing.psi[2] / 2 : facing.psi[1];
    };
    const double a = part(from, from.begin);
    const double b = part(to, to.end);
    const double slope = (to.end - from.begin) / (b - a);
    const double begin = from.begin - a * slope;
    const double end = begin + slope;
    if (nodes.empty() || begin > nodes.back() + negligiblePart * (end - begin)) nodes.push_back(begin);
    if (quadratic) nodes.push_back((begin + end) / 2);
    nodes.push_back(end);
    k = last + 1;
  }
  return nodes;
}

}  // namespace mortier
