#include "contact/sliding.h"

#include <algorithm>
#include <cmath>
#include <limits>

namespace mortier {
namespace {

/// Displacements turned by -90 degrees: C of them is T of what they were.
Vector turned(const Vector& u) {
  Vector result(u.size());
  for (Eigen::Index i = 0; i < u.size(); i += 2) result.segment<2>(i) << u[i + 1], -u[i];
  return result;
}

/// The line of the mortar side by its vertices.
struct Polyline {
  std::vector<Point> points;
  std::vector<double> s{0};
  bool closed = false;  ///< its ends are no farther apart than its edges are long

  explicit Polyline(const std::vector<Point>& vertices) : points(vertices) {
    double longest = 0;
    for (size_t i = 1; i < points.size(); ++i) {
      const double length = (points[i] - points[i - 1]).norm();
      longest = std::max(longest, length);
      s.push_back(s.back() + length);
    }
    closed = points.size() > 2 && (points.back() - points.front()).norm() <= 1.5 * longest;
  }

  /// How far it extends along `way` from where a point faces it along n; from its nearest vertex where no
  /// point does.
  [[nodiscard]] double room(const Point& x, const Point& n, const Point& way) const {
    double least = std::numeric_limits<double>::infinity();
    double nearest = least;
    double at = 0;
    bool onwards = true;
    for (size_t i = 0; i < points.size(); ++i) {
      const Point along = i + 1 < points.size() ? points[i + 1] - points[i] : points[i] - points[i - 1];
      const bool here = along.dot(way) > 0;
      if (const double far = (points[i] - x).norm(); std::isinf(least) && far < nearest) {
        nearest = far;
        at = s[i];
        onwards = here;
      }
      const double slope = cross(along, n);
      if (i + 1 == points.size() || slope == 0) continue;
      const double part = cross(x - points[i], n) / slope;
      const double distance = std::abs((points[i] + part * along - x).dot(n));
      if (part < 0 || part > 1 || distance >= least) continue;
      least = distance;
      at = s[i] + part * (s[i + 1] - s[i]);
      onwards = here;
    }
    return onwards ? s.back() - at : at;
  }
};

}  // namespace

Sliding slidingOf(const ContactInterface& interface, const ContactMesh& nonmortar, const ContactMesh& mortar,
                  const Vector& uNonmortar, const Vector& uMortar, const Vector& p) {
  constexpr double ofTheLine = 0.1;
  const std::vector<int>& nodes = interface.nonmortarNodes();
  const auto place = [&](int row) -> const Point& { return nonmortar.nodes.places[nodes[row]]; };
  const auto isMiddle = [](const ContactMesh& of, int node) {
    return node >= static_cast<int>(of.mesh.vertices.size());
  };
  const bool middles =
      std::any_of(nodes.begin(), nodes.end(), [&](int node) { return isMiddle(nonmortar, node); });
  const auto edgeAt = [&](int row) {
    double length = std::numeric_limits<double>::infinity();
    for (const int other : {row - 1, row + 1}) {
      if (other < 0 || other >= interface.rows()) continue;
      const double far = (place(other) - place(row)).norm();
      if (far > 0) length = std::min(length, middles ? 2 * far : far);
    }
    return std::isinf(length) ? interface.lengths()[row] : length;
  };
  const Vector slip = interface.jump(turned(uNonmortar), turned(uMortar));
  Sliding sliding;
  std::vector<Point> line;
  for (int row = 0; row < interface.rows(); ++row) {
    if (!(p[row] > 0)) continue;
    const double by = std::abs(slip[row]);
    const double edge = edgeAt(row);
    if (by > sliding.edges * edge) {
      sliding.slip = by;
      sliding.edges = by / edge;
    }
    if (!(by > edge) || by <= sliding.pastBy) continue;
    if (line.empty())
      for (const int node : interface.mortarNodes())
        if (!isMiddle(mortar, node)) line.push_back(mortar.nodes.places[node]);
    const Polyline across(line);
    if (across.closed) continue;
    const Point n = interface.normals()[row].head<2>();
    const Point way = (slip[row] > 0 ? 1 : -1) * Point(-n.y(), n.x());
    const double past = by - across.room(place(row), n, way);
    if (!(past > edge && past > ofTheLine * across.s.back())) continue;
    sliding.past = nodes[row];
    sliding.pastBy = by;
  }
  return sliding;
}

Sliding slidingInSpace(const ContactInterface& interface, const Vector& uNonmortar, const Vector& uMortar,
                       const Vector& p) {
  const ContactInterface::SurfacePoints& points = interface.surfacePoints();
  const Vector pressed = points.rows * p;
  const Matrix jump = points.jump(uNonmortar, uMortar);
  Sliding most;
  for (Eigen::Index i = 0; i < pressed.size(); ++i) {
    if (!(pressed[i] > 0)) continue;
    const SpacePoint& n = points.normals[i];
    const double slip = (jump.col(i) - n.dot(jump.col(i)) * n).norm();
    if (slip / points.sizes[0][i] <= most.edges) continue;
    most.slip = slip;
    most.edges = slip / points.sizes[0][i];
  }
  return most;
}

}  // namespace mortier
