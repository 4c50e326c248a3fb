#include "mesh/triangle_mesh.h"

#include <algorithm>
#include <array>
#include <cmath>

namespace mortier {
namespace {

constexpr int degree = 8;

/// The place in [0, 1] at a part of the angle between two neighbours; at whole j, those of the points.
double chebyshevPlace(double j) {
  const double sine = std::sin(M_PI * j / (2 * degree));
  return j == degree ? 1 : sine * sine;
}

Point interpolated(const Point* points, double place) {
  static const std::array<double, degree + 1> places = [] {
    std::array<double, degree + 1> result{};
    for (int j = 0; j <= degree; ++j) result[j] = chebyshevPlace(j);
    return result;
  }();
  Point sum = Point::Zero();
  double weights = 0;
  for (int j = 0; j <= degree; ++j) {
    const double distance = place - places[j];
    if (distance == 0) return points[j];
    const double weight = (j == 0 || j == degree ? 0.5 : 1) * (j % 2 == 0 ? 1 : -1) / distance;
    sum += weight * points[j];
    weights += weight;
  }
  return sum / weights;
}

}  // namespace

Point SampledCurve::at(double t) const {
  const auto above = std::upper_bound(knots.begin() + 1, knots.end() - 1, t);
  const auto piece = above - knots.begin() - 1;
  return interpolated(&points[degree * piece], (t - knots[piece]) / (*above - knots[piece]));
}

SampledCurve sampled(const std::function<std::vector<Point>(const std::vector<double>&)>& points,
                     double tolerance) {
  constexpr size_t most = 4096;  // pieces
  SampledCurve curve{{0}, {}};
  std::vector<double> ends{1};  // of the pieces to come, the next one last
  while (!ends.empty()) {
    const double begin = curve.knots.back();
    const double length = ends.back() - begin;
    std::vector<double> t;
    for (int j = 0; j <= 2 * degree; ++j) t.push_back(begin + length * chebyshevPlace(j / 2.0));
    t.back() = ends.back();
    const std::vector<Point> all = points(t);
    std::vector<Point> nodes;
    for (int j = 0; j <= degree; ++j) nodes.push_back(all[2 * j]);
    bool fits = true;
    for (int j = 1; j < 2 * degree; j += 2)
      fits = fits && (interpolated(nodes.data(), chebyshevPlace(j / 2.0)) - all[j]).norm() <= tolerance;
    if (!fits) {
      const double half = begin + length / 2;
      if (curve.knots.size() + ends.size() > most || half == begin || half == ends.back()) return {};
      ends.push_back(half);
      continue;
    }
    curve.points.insert(curve.points.end(), nodes.begin(), nodes.end() - (ends.size() > 1 ? 1 : 0));
    curve.knots.push_back(ends.back());
    ends.pop_back();
  }
  return curve;
}

double EdgeCurve::meeting(const Point& x, const Point& n) const {
  const auto isLeft = [&](double t) { return cross(n, at(t) - x) > 0; };
  const bool first = isLeft(from);
  if (isLeft(to) == first) {
    const auto distance = [&](double t) { return std::abs(cross(n, at(t) - x)); };
    return distance(from) <= distance(to) ? from : to;
  }
  constexpr int bits = 60;
  double before = from;
  double after = to;
  for (int i = 0; i < bits; ++i) {
    const double t = (before + after) / 2;
    (isLeft(t) == first ? before : after) = t;
  }
  return after;
}

double EdgeCurve::middle() const {
  const Point a = at(from);
  const Point half = (at(to) - a) / 2;
  return meeting(a + half, {-half.y(), half.x()});
}

}  // namespace mortier
