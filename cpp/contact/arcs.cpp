#include "contact/smooth_part.h"

#include <algorithm>
#include <cmath>

namespace mortier {
namespace {

constexpr double fit = 1e-6;
/// Of places, over the extent of their line.
constexpr double roundingOfNodes = 1e-13;
/// Nodes of the shortest run that shows more than that three points lie on a circle.
constexpr int fewest = 4;

/// Of the circle through three points, in their order.
double curvatureThrough(const Point& a, const Point& b, const Point& c) {
  const double product = (b - a).norm() * (c - b).norm() * (c - a).norm();
  return product > 0 ? 2 * cross(b - a, c - b) / product : 0;
}

/// The arc on which the nodes begin .. end lie, if there is one.
Arc arcThrough(const std::vector<Point>& x, int begin, int end, bool closed) {
  const int step = closed ? (end - begin) / 3 : (end - begin) / 2;
  const Point& a = x[begin];
  const Point& b = x[begin + step];
  const Point& c = closed ? x[begin + 2 * step] : x[end];
  double extent = 0;
  for (int i = begin; i <= end; ++i) extent = std::max(extent, (x[i] - a).norm());
  const double curvature = curvatureThrough(a, b, c);
  if (std::abs(curvature) * extent < fit) {
    const Point along = (c - a).normalized();
    for (int i = begin; i <= end; ++i)
      if (!(std::abs(cross(along, x[i] - a)) <= fit * extent)) return {};
    return {0, true};
  }
  const double radius = 1 / std::abs(curvature);
  const Point half = (c - a) / 2;
  const Point left = Point(-half.y(), half.x()).normalized();
  // The centre is on the left of the chord where the arc turns left and is less than half the circle.
  const double height = std::sqrt(std::max(0.0, radius * radius - half.squaredNorm()));
  const double side = (b - a).dot(b - c) > 0 ? -1 : 1;
  const Point centre = a + half + (curvature > 0 ? side : -side) * height * left;
  for (int i = begin; i <= end; ++i)
    if (!(std::abs((x[i] - centre).norm() - radius) <= fit * std::min(extent, radius))) return {};
  return {curvature, true};
}

/// The last node of the longest run from `begin` that is found by doubling and halving.
int endOfRun(const std::vector<Point>& x, int begin, int last) {
  const auto fits = [&](int end) { return arcThrough(x, begin, end, false).known; };
  int good = begin + fewest - 1;
  if (good > last || !fits(good)) return begin;
  int bad = last + 1;
  for (int step = fewest; good < last; step *= 2) {
    const int next = std::min(last, good + step);
    if (!fits(next)) {
      bad = next;
      break;
    }
    good = next;
  }
  while (bad - good > 1) {
    const int middle = (good + bad) / 2;
    (fits(middle) ? good : bad) = middle;
  }
  return good;
}

}  // namespace

std::vector<double> nodalCurvatures(const std::vector<Point>& points, bool closed) {
  const size_t n = points.size();
  std::vector<double> curvatures(n, 0);
  for (size_t i = 1; i + 1 < n; ++i)
    curvatures[i] = curvatureThrough(points[i - 1], points[i], points[i + 1]);
  if (n < 3) return curvatures;
  curvatures.front() = closed ? curvatureThrough(points[n - 2], points[0], points[1]) : curvatures[1];
  curvatures.back() = closed ? curvatures.front() : curvatures[n - 2];
  return curvatures;
}

namespace {

std::vector<Arc> fittedArcs(const std::vector<Point>& points, bool closed) {
  const auto last = static_cast<int>(points.size()) - 1;
  std::vector<Arc> arcs(last);
  const std::vector<double> nodal = nodalCurvatures(points, closed);
  for (int e = 0; e < last; ++e) arcs[e].curvature = (nodal[e] + nodal[e + 1]) / 2;
  const auto set = [&](int begin, int end, const Arc& arc) {
    for (int e = begin; e < end; ++e)
      if (!arcs[e].known) arcs[e] = arc;
  };
  if (closed && last < fewest) return arcs;
  if (closed)
    if (const Arc arc = arcThrough(points, 0, last, true); arc.known) {
      set(0, last, arc);
      return arcs;
    }
  for (int begin = 0; begin < last;) {
    int end = endOfRun(points, begin, last);
    if (end > begin) {
      set(begin, end, arcThrough(points, begin, end, false));
    } else {
      // The end of a run, where it is too short to begin one.
      const int first = std::max(0, begin + 1 - (fewest - 1));
      if (const Arc arc =
              begin + 1 - first == fewest - 1 ? arcThrough(points, first, begin + 1, false) : Arc{};
          arc.known)
        set(begin, begin + 1, arc);
      end = begin + 1;
    }
    begin = end;
  }
  return arcs;
}

}  // namespace

std::vector<Arc> arcsOf(const std::vector<Point>& points, bool closed, const std::vector<Point>& middles) {
  std::vector<Arc> arcs = fittedArcs(points, closed);
  double extent = 0;
  for (const Point& x : points) extent = std::max(extent, (x - points.front()).norm());
  const auto ofGeometry = [&](size_t e) { return curvatureThrough(points[e], middles[e], points[e + 1]); };
  const auto agrees = [&](size_t e) {
    const double length = (points[e + 1] - points[e]).norm();
    return arcs[e].known && sagitta(length, ofGeometry(e) - arcs[e].curvature) <= roundingOfNodes * extent;
  };
  // A fit through nodes may go on from a straight side into the arc beside it: middles of a geometry decide
  // about all edges of a fit.
  for (size_t begin = 0, end = 0; begin < middles.size(); begin = end) {
    bool all = true;
    for (; end < middles.size() && middles[end].allFinite() && arcs[end].known == arcs[begin].known &&
           arcs[end].curvature == arcs[begin].curvature;
         ++end)
      all = all && agrees(end);
    for (size_t e = begin; e < end && !all; ++e) arcs[e] = {ofGeometry(e), true};
    if (end == begin) ++end;
  }
  return arcs;
}

double turnOfPolygon(const std::vector<Point>& points, bool closed, double least) {
  std::vector<Point> x = points;
  if (closed && x.size() > 2) x.insert(x.end(), {points[1], points[2]});
  double sharpest = 0;
  for (size_t i = 0; i + fewest < x.size(); ++i) {  // through four of an ellipse one may go
    const auto begin = static_cast<int>(i);
    const Arc arc = arcThrough(x, begin, begin + fewest, false);
    if (!arc.known || arc.curvature == 0) continue;
    for (size_t k = i + 1; k <= i + 3; ++k) {
      const Point before = x[k] - x[k - 1];
      const Point after = x[k + 1] - x[k];
      const double turn = std::abs(std::atan2(cross(before, after), before.dot(after)));
      if (turn > least) sharpest = std::max(sharpest, turn);
    }
  }
  return sharpest;
}

double distanceTo(const Arc& arc, const Point& a, const Point& b, const Point& x, const Point& n) {
  if (arc.curve.known()) return (arc.curve.at(arc.curve.meeting(x, n)) - x).dot(n);
  return arc.known && arc.curvature != 0 ? distanceToArc(a, b, arc.curvature, x, n) : 0;
}

double distanceToArc(const Point& a, const Point& b, double curvature, const Point& x, const Point& n) {
  const Point chord = b - a;
  const double h = chord.norm();
  // With the power -P of x in the circle and v = (x - centre) . n: the smaller root of t^2 + 2 v t - P = 0.
  const double half = curvature * h / 2;
  const double cosine = std::sqrt(std::max(0.0, 1 - half * half));
  const Point right = Point(chord.y(), -chord.x()) / h;
  const Point fromMiddle = x - a - chord / 2;
  const double power =
      curvature * (x - a).dot(b - x) - 2 * cosine * fromMiddle.dot(right);  // times the curvature
  const double q = curvature * fromMiddle.dot(n) + right.dot(n) * cosine;
  return power / (q + std::sqrt(std::max(0.0, q * q + curvature * power)));
}

}  // namespace mortier
