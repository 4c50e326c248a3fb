#include "contact/directions.h"

#include <algorithm>
#include <cmath>
#include <utility>

#include "contact/false_position.h"

namespace mortier {
namespace {

/// The slope of the distance at which contact at an end begins to count: half a degree.
constexpr double leastSlope = 0.0087;
/// From which it counts in full: one degree.
constexpr double fullSlope = 0.0175;
/// The same of a condition at the corner itself. Means over row functions find blunter corners early enough,
/// and are more accurate where bodies flatten them.
constexpr double leastSlopeOfPoint = 0.1;
constexpr double fullSlopeOfPoint = 0.15;
/// Vertices from an end on over which the distance has to rise from there.
constexpr size_t verticesAtEnd = 3;
/// The end of a line that does not go on behind a corner faces the other line up to 60 degrees.
constexpr double steepest = 1.7320508075688772;
constexpr double steepestSine = 0.8660254037844386;
/// A corner is visible if a ray aside by this part of a nonmortar element meets the line as far off as it, to
/// within another part of the element.
constexpr double aside = 1e-6;
constexpr double sameCorner = 1e-3;

/// A vertex of the part and what is ahead of it along its own normal.
struct Ahead {
  LineHit hit;
  double slope = 0;  ///< of the distance along the part [-]
  int part = -1;     ///< of the mortar line; -1: nothing is ahead
};

class Directions {
 public:
  Directions(const SmoothPart& part, const MortarLine& mortar, std::optional<double> mortarShare)
      : part_(part), mortar_(mortar), share_(mortarShare), count_(part.elements() + (part.closed ? 0 : 1)) {
    for (int i = 0; i < count_; ++i) ahead_.push_back(aheadOf(i));
  }

  ContactDirections find(const ContactDirections* kept) {
    toEnd_.assign(count_, 0);
    toMortarEnd_.assign(count_, 0);
    for (const int way : {-1, 1}) findEnds(way);
    kept_ = kept;
    shares_ = kept != nullptr ? kept->mortarShare : std::vector<double>(count_, 0);
    for (int i = 0; i < count_; ++i) {
      LineHit hit = ahead_[i].hit;
      n_.push_back(directionAt(i, hit));
      const bool end = !part_.closed && (i == 0 || i == part_.elements());
      const bool faces = end && (part_.corners[i == 0 ? 0 : 1] || std::abs(ahead_[i].slope) < steepest);
      const double weight = std::min(pointWeightOf(std::abs(ahead_[i].slope)), toEnd_[i]);
      if (kept == nullptr && faces && hit.found() && ahead_[i].part >= 0 && weight > 0)
        add({i, std::min(i, part_.elements() - 1), part_.s[i], hit.element, weight, true});
      if (kept == nullptr) continue;
      for (CornerContact corner : kept->corners)
        if (corner.ofPart && corner.vertex == i && hit.found()) {
          corner.s = part_.s[i];
          corner.mortar = hit.element;
          add(corner);
        }
    }
    if (part_.closed) n_.push_back(n_.front());
    if (kept != nullptr) {
      for (const CornerContact& corner : kept->corners)
        if (!corner.ofPart) findCorner(corner.node, &corner);
    } else {
      for (int j = 0; j <= mortar_.elements(); ++j) findCorner(j, nullptr);
    }
    return {std::move(n_), std::move(corners_), std::move(shares_)};
  }

 private:
  [[nodiscard]] Ahead aheadOf(int i) const {
    const Point& n = part_.normals[i];
    Ahead ahead{mortar_.along(part_.points[i], n)};
    if (!ahead.hit.found()) return ahead;
    const Point across = -mortar_.normalAt(ahead.hit.element, ahead.hit.xi);
    const double cosine = n.dot(across);
    if (!(cosine > 0)) return ahead;
    ahead.part = mortar_.geometry[ahead.hit.element].part;
    ahead.slope = -Point(-n.y(), n.x()).dot(across) / cosine;
    return ahead;
  }

  /// The vertex next to one; -1 past the ends.
  [[nodiscard]] int next(int i, int way) const {
    if (part_.closed) return (i + way + count_) % count_;
    return i + way < count_ ? i + way : -1;
  }

  /// Weights of the vertices from which the distance falls along `way` to an end of either line.
  void findEnds(int way) {
    const auto rise = [&](int i) { return -way * ahead_[i].slope; };  // away from the end
    const auto goesOn = [&](int from, int to) {
      return to >= 0 && ahead_[to].part >= 0 && ahead_[to].part == ahead_[from].part;
    };
    for (int end = 0; end < count_; ++end) {
      const int beyond = next(end, way);
      if (ahead_[end].part < 0 || !(rise(end) > leastSlope) || goesOn(end, beyond)) continue;
      std::vector<int> run;
      bool falls = true;
      for (int i = end; falls && static_cast<int>(run.size()) < count_;) {
        run.push_back(i);
        const int after = next(i, -way);
        if (!goesOn(i, after)) break;
        falls = rise(after) > leastSlope;
        i = after;
      }
      if (!falls && run.size() < verticesAtEnd) continue;
      std::vector<double>& weight = beyond < 0 && !facesMortarEnd(end) ? toEnd_ : toMortarEnd_;
      double least = infinity;
      for (size_t k = 0; k < run.size(); ++k) {
        least = std::min(least, rise(run[k]));
        if (k + 1 < std::min(verticesAtEnd, run.size())) continue;
        for (size_t j = k + 1 == verticesAtEnd || k + 1 == run.size() ? 0 : k; j <= k; ++j)
          weight[run[j]] = std::max(weight[run[j]], weightOf(least));
      }
    }
  }

  /// Whether a vertex faces an end of the mortar line: as on an axis of symmetry, where the part goes on.
  [[nodiscard]] bool facesMortarEnd(int i) const {
    const auto& [element, xi, distance] = ahead_[i].hit;
    const double length = (mortar_.points[element + 1] - mortar_.points[element]).norm();
    const double near = aside * lengthAt(i);
    const bool begins = !mortar_.closed && element == 0 && xi * length <= near;
    const bool ends = !mortar_.closed && element + 1 == mortar_.elements() && (1 - xi) * length <= near;
    return begins || ends || mortar_.toCorner(element, xi) <= near;
  }

  static double pointWeightOf(double slope) {
    return std::clamp((slope - leastSlopeOfPoint) / (fullSlopeOfPoint - leastSlopeOfPoint), 0.0, 1.0);
  }
  static double weightOf(double slope) {
    return std::clamp((slope - leastSlope) / (fullSlope - leastSlope), 0.0, 1.0);
  }

  [[nodiscard]] double lengthAt(int i) const {
    const int last = part_.elements() - 1;
    const int before = i > 0 ? i - 1 : (part_.closed ? last : 0);
    const int after = std::min(i, last);
    return std::max(part_.s[before + 1] - part_.s[before], part_.s[after + 1] - part_.s[after]);
  }

  [[nodiscard]] double toCorner(int i, const LineHit& hit) const {
    return mortar_.toCorner(hit.element, hit.xi, part_.normals[i]);
  }

  [[nodiscard]] double mortarShare(int i, double curvature, double toCorner) const {
    if (kept_ != nullptr) return shares_[i];
    double share = 0;
    if (share_)
      share = *share_;
    else if (!part_.straight)
      share =
          part_.curvatures[i] + curvature > 0 ? part_.curvatures[i] / (part_.curvatures[i] + curvature) : 0.5;
    share *= std::min(1.0, toCorner / lengthAt(i));
    return toEnd_[i] + (1 - toEnd_[i] - toMortarEnd_[i]) * share;
  }

  Point blended(int i, const Point& n2, double curvature, double toCorner) {
    const double share = shares_[i] = mortarShare(i, curvature, toCorner);
    const Point n = (1 - share) * part_.normals[i] - share * n2;
    return share > 0 && n.norm() > 0 ? Point(n.normalized()) : part_.normals[i];
  }

  /// \param hit  along n1; becomes that along the direction
  Point directionAt(int i, LineHit& hit) {
    constexpr int most = 30;
    constexpr double same = 1e-15;
    if (ahead_[i].part < 0) hit = acrossFrom(i);
    if (!hit.found()) return besideEnd(i);
    const LineHit first = hit;
    // In a reentrant corner the share moves what is faced away from the corner, by which it would grow.
    const double toFirst = toCorner(i, first);
    const bool fades = std::isfinite(toFirst) && toEnd_[i] == 0;
    Point n = part_.normals[i];
    for (int k = 0; k < most; ++k) {
      const Point before = n;
      n = blended(i, mortar_.normalAt(hit.element, hit.xi), mortar_.curvatureAt(hit.element, hit.xi),
                  std::min(toFirst, toCorner(i, hit)));
      if ((n - before).lpNorm<Eigen::Infinity>() <= same) return n;
      hit = mortar_.along(part_.points[i], n);
      if (!hit.found() && !fades) return n;
      if (!hit.found()) break;
    }
    return fades ? besideCorner(i, first, hit) : n;
  }

  /// Where w and what is faced do not settle: a steep side is far off, and the ray jumps to and fro over its
  /// end. The share w(hit) falls to 0 towards that end, so that it equals w in between.
  Point besideCorner(int i, const LineHit& first, LineHit& hit) {
    const double toFirst = toCorner(i, first);
    constexpr int halvings = 50;
    const Point n2 = mortar_.normalAt(first.element, first.xi);
    const double curvature = mortar_.curvatureAt(first.element, first.xi);
    const auto ray = [&](double share) {
      return Point(((1 - share) * part_.normals[i] - share * n2).normalized());
    };
    double share = kept_ != nullptr ? shares_[i] : 0;
    double above = kept_ != nullptr ? share : 1;
    for (int k = 0; k < halvings && share < above; ++k) {
      const double middle = (share + above) / 2;
      const LineHit there = mortar_.along(part_.points[i], ray(middle));
      const bool samePart =
          there.found() && mortar_.geometry[there.element].part == mortar_.geometry[first.element].part;
      const bool isBelow =
          samePart && mortarShare(i, curvature, std::min(toFirst, toCorner(i, there))) > middle;
      (isBelow ? share : above) = middle;
    }
    shares_[i] = share;
    hit = mortar_.along(part_.points[i], ray(share));
    return ray(share);
  }

  /// What a vertex on a curve whose own normal misses the mortar line faces: the ray along the normal of the
  /// nearest point of that line that it may face, so that the length of the line does not matter, nor what it
  /// has behind its corners.
  [[nodiscard]] LineHit acrossFrom(int i) const {
    if (part_.straight || share_ == 0.0) return {};
    const Point& n = part_.normals[i];
    const LineHit nearest = mortar_.nearestTo(part_.points[i], n);
    if (!nearest.found()) return {};
    const LineHit hit = mortar_.along(part_.points[i], -mortar_.normalAt(nearest.element, nearest.xi));
    return hit.found() && mortar_.mayFace(hit.element, hit.xi, n) ? hit : LineHit{};
  }

  /// At a vertex past an end of the mortar line by less than an element: as at that end.
  Point besideEnd(int i) {
    const Point& n = part_.normals[i];
    if (mortar_.closed || part_.straight) return n;
    for (const int end : {0, mortar_.elements()}) {
      const int element = end == 0 ? 0 : end - 1;
      const auto at = static_cast<size_t>(end == 0 ? 0 : 1);
      const Point& n2 = mortar_.geometry[element].normals[at];
      const double past = (end == 0 ? 1 : -1) * cross(part_.points[i] - mortar_.points[end], n);
      if (!(past > 0 && past < lengthAt(i) && n.dot(n2) < -0.5)) continue;
      const double rise = (end == 0 ? 1 : -1) * n.dot(mortar_.direction(element));
      toMortarEnd_[i] = risesTo(next(i, end == 0 ? 1 : -1), element, weightOf(rise));
      return blended(i, n2, mortar_.geometry[element].curvatures[at], infinity);
    }
    return n;
  }

  void add(const CornerContact& corner) {
    for (CornerContact& each : corners_)
      if (each.vertex == corner.vertex) {
        if (each.weight < corner.weight) each = corner;
        return;
      }
    corners_.push_back(corner);
  }

  /// Where the part faces a corner or an end of the mortar line from which both lines part.
  /// \param kept  the contact there that was found before
  void findCorner(int node, const CornerContact* kept) {
    const int last = mortar_.elements();
    const int before = node > 0 ? node - 1 : (mortar_.closed ? last - 1 : -1);
    const int after = node < last ? node : -1;
    const bool isEnd = before < 0 || after < 0;
    if ((mortar_.closed && node == last) || (!isEnd && mortar_.geometry[after].toCorner[0] > 0)) return;
    const Point& y = mortar_.points[node];
    double nearest = infinity;
    CornerContact corner;
    for (int e = 0; e < part_.elements(); ++e) {
      const auto product = [&](double xi) { return cross(y - part_.at(e, xi), between(n_, e, xi)); };
      const double f0 = product(0);
      const double f1 = product(1);
      if (!(f1 >= 0 && (f0 < 0 || (f0 == 0 && e == 0 && !part_.closed)))) continue;
      const double xi = f0 == 0 ? 0 : rootOf(product, f0, f1);
      const Point x = part_.at(e, xi);
      const Point n = between(n_, e, xi).normalized();
      const double distance = std::abs((y - x).dot(n));
      if (!(distance < nearest)) continue;
      const double weight = kept != nullptr ? kept->weight : weightAt(e, before, after, n);
      if (!(weight > 0)) continue;
      const double length = part_.s[e + 1] - part_.s[e];
      if (!isVisible(e, xi, (y - x).dot(n))) continue;
      nearest = distance;
      int vertex = xi <= 0.5 ? e : e + 1;
      if (part_.closed && vertex == part_.elements()) vertex = 0;
      if (kept != nullptr) vertex = kept->vertex;
      corner = {vertex, e, part_.s[e] + xi * length, after >= 0 ? after : before, weight, false, node};
    }
    if (std::isfinite(nearest)) add(corner);
  }

  /// Whether nothing hides a corner of the mortar line that an element faces at a distance.
  [[nodiscard]] bool isVisible(int element, double xi, double distance) const {
    const double length = part_.s[element + 1] - part_.s[element];
    for (const double beside : {xi - aside, xi + aside}) {
      const Point n = between(n_, element, beside).normalized();
      const LineHit hit = mortar_.along(part_.at(element, beside), n);
      if (hit.found() && std::abs(hit.distance - distance) <= sameCorner * length) return true;
    }
    return false;
  }

  /// The weight of a corner of the mortar line between two of its elements (-1: none), at a nonmortar
  /// element.
  [[nodiscard]] double weightAt(int element, int before, int after, const Point& n) const {
    const double down = before < 0 ? infinity : -n.dot(mortar_.direction(before));
    const double up = after < 0 ? infinity : n.dot(mortar_.direction(after));
    if ((before < 0 || after < 0) && std::min(down, up) > steepestSine) return 0;
    return std::min(before < 0 ? 1.0 : risesTo(element, before, pointWeightOf(down)),
                    after < 0 ? 1.0 : risesTo(element + 1, after, pointWeightOf(up)));
  }

  /// The weight of a corner by one side of it: over several vertices where that side is ahead of the next
  /// one.
  [[nodiscard]] double risesTo(int vertex, int element, double weight) const {
    const int i = part_.closed && vertex == count_ ? 0 : vertex;
    const bool isAhead = i >= 0 && ahead_[i].part == mortar_.geometry[element].part;
    return isAhead ? std::min(weight, toMortarEnd_[i]) : weight;
  }

  const SmoothPart& part_;
  const MortarLine& mortar_;
  std::optional<double> share_;
  int count_;
  std::vector<Ahead> ahead_;
  std::vector<double> toEnd_, toMortarEnd_;  ///< weights of contact at an end, by vertices
  std::vector<double> shares_;               ///< w, by vertices
  const ContactDirections* kept_ = nullptr;
  std::vector<Point> n_;
  std::vector<CornerContact> corners_;
};

}  // namespace

ContactDirections contactDirections(const SmoothPart& part, const MortarLine& mortar,
                                    std::optional<double> mortarShare, const ContactDirections* kept) {
  return Directions(part, mortar, mortarShare).find(kept);
}

}  // namespace mortier
