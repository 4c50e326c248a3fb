#include "mesh/shape.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numeric>

#include "base/dense_templates.h"
#include "base/error.h"

namespace mortier {
namespace {

/// A circle that the edges of some labels stand for.
struct Circle {
  int label = 0;
  Point centre;
  double radius = 1;  ///< negative where the body lies outside [m]
};

/// The mesh with the middles of these edges on their circles.
TriangleMesh onCircles(TriangleMesh mesh, const std::vector<Circle>& circles) {
  constexpr double unknown = std::numeric_limits<double>::quiet_NaN();
  mesh.edgeMiddles.assign(mesh.boundaryEdges.size(), Point(unknown, unknown));
  for (size_t e = 0; e < mesh.boundaryEdges.size(); ++e)
    for (const Circle& circle : circles) {
      if (mesh.boundaryLabels[e] != circle.label) continue;
      const auto& [a, b] = mesh.boundaryEdges[e];
      const Point along = (mesh.vertices[b] - mesh.vertices[a]).normalized();
      mesh.edgeMiddles[e] = circle.centre + circle.radius * Point(along.y(), -along.x());
    }
  return mesh;
}

}  // namespace

TriangleMesh shapeMesh(const MeshShape& shape) {
  if (const auto* of = std::get_if<Rectangle>(&shape.of)) return rectangleMesh(*of, shape.cut);
  if (const auto* of = std::get_if<Quadrilateral>(&shape.of)) return quadrilateralMesh(*of, shape.cut);
  if (const auto* of = std::get_if<Outline>(&shape.of)) return outlineMesh(*of);
  if (const auto* of = std::get_if<Annulus>(&shape.of))
    return onCircles(annulusMesh(*of, shape.cut), {{1, of->centre, -of->inner}, {2, of->centre, of->outer}});
  const auto& disc = std::get<HalfDisc>(shape.of);
  const Point centre = disc.lowest + Point(0, disc.radius);
  return onCircles(halfDiscMesh(disc, shape.cut), {{1, centre, disc.radius}, {3, centre, disc.radius}});
}

namespace {

constexpr int edgesOfCircle = 720;
constexpr int edgesOfSpan = 32;  // between two points of a spline

/// The second derivatives at the knots of the cubic spline with these values.
Matrix bends(const Vector& knots, const Matrix& values, bool periodic) {
  const Eigen::Index n = knots.size() - 1;
  Matrix system = Matrix::Zero(n + 1, n + 1);
  Matrix right = Matrix::Zero(n + 1, 2);
  const auto slope = [&](Eigen::Index i) -> Eigen::RowVector2d {
    return (values.row(i + 1) - values.row(i)) / (knots[i + 1] - knots[i]);
  };
  const auto smooth = [&](Eigen::Index row, Eigen::Index before, Eigen::Index at) {
    const double h0 = knots[before + 1] - knots[before];
    const double h1 = knots[at + 1] - knots[at];
    system(row, before) += h0 / 6;
    system(row, at) += (h0 + h1) / 3;
    system(row, at + 1) += h1 / 6;
    right.row(row) = slope(at) - slope(before);
  };
  for (Eigen::Index i = 1; i < n; ++i) smooth(i, i - 1, i);
  system(n, n) = 1;
  if (periodic) {
    smooth(0, n - 1, 0);
    system(n, 0) = -1;
  } else {
    system(0, 0) = 1;
  }
  return system.partialPivLu().solve(right);
}

/// Doubled, of the triangle; positive when counterclockwise.
double areaOf(const Point& a, const Point& b, const Point& c) {
  return cross(b - a, c - a);
}

/// Whether the corner may be cut off: it turns left, and no other corner lies in it.
bool isEar(const std::vector<Point>& x, const std::vector<int>& ring, size_t k) {
  const size_t n = ring.size();
  const int a = ring[(k + n - 1) % n];
  const int b = ring[k];
  const int c = ring[(k + 1) % n];
  if (!(areaOf(x[a], x[b], x[c]) > 1e-12 * (x[c] - x[a]).squaredNorm())) return false;
  return std::none_of(ring.begin(), ring.end(), [&](int v) {
    return v != a && v != b && v != c && areaOf(x[a], x[b], x[v]) >= 0 && areaOf(x[b], x[c], x[v]) >= 0 &&
           areaOf(x[c], x[a], x[v]) >= 0;
  });
}

}  // namespace

Outline discOutline(const Point& centre, double radius, bool axisymmetric) {
  Outline outline;
  const bool half = axisymmetric && centre.x() == 0;
  const int edges = half ? edgesOfCircle / 2 : edgesOfCircle;
  for (int i = 0; i < edges + (half ? 1 : 0); ++i) {
    const double angle = 2 * M_PI * i / edgesOfCircle - M_PI / 2;
    const double across = half && (i == 0 || i == edges) ? 0 : std::cos(angle);
    outline.points.emplace_back(centre + radius * Point(across, std::sin(angle)));
  }
  outline.labels.assign(outline.points.size(), 1);
  if (half) outline.labels.back() = 2;
  return outline;
}

Outline lineOutline(const Point& from, const Point& to) {
  constexpr double depth = 0.05;  // of its length: it is drawn so
  const Point along = to - from;
  const Point left = depth * Point(-along.y(), along.x());
  return {{from, to, to + left, from + left}, {1, 2, 2, 2}, {}, {}, {{sideBehind, 2}}};
}

Outline splineOutline(const std::vector<Point>& points) {
  const bool closed = points.front() == points.back();
  const auto last = static_cast<Eigen::Index>(points.size()) - 1;
  Matrix values(last + 1, 2);
  Vector knots(last + 1);
  for (Eigen::Index i = 0; i <= last; ++i) {
    values.row(i) = points[i].transpose();
    knots[i] = i == 0 ? 0 : knots[i - 1] + (points[i] - points[i - 1]).norm();
  }
  const double length = knots[last];
  const Matrix bend = bends(knots, values, closed);
  constexpr double rounding = 1e-11;  // of its length
  SampledCurve pieces{{0}, {}};
  for (Eigen::Index i = 0; i < last; ++i) {
    const double h = knots[i + 1] - knots[i];
    const SampledCurve span = sampled(
        [&](const std::vector<double>& places) {
          std::vector<Point> result;
          for (const double b : places) {
            const double a = 1 - b;
            result.emplace_back(
                (a * values.row(i) + b * values.row(i + 1) +
                 ((a * a * a - a) * bend.row(i) + (b * b * b - b) * bend.row(i + 1)) * h * h / 6)
                    .transpose());
          }
          return result;
        },
        rounding * length);
    if (span.points.empty())
      throw InputError("larger distances between points: rounding of the coordinates bends the spline");
    for (size_t k = 1; k < span.knots.size(); ++k)
      pieces.knots.push_back((knots[i] + span.knots[k] * h) / length);
    pieces.points.insert(pieces.points.end(), span.points.begin(),
                         span.points.end() - (i + 1 < last ? 1 : 0));
  }
  pieces.knots.back() = 1;
  const auto curve = std::make_shared<const SampledCurve>(std::move(pieces));
  Outline outline;
  for (Eigen::Index i = 0; i < last; ++i)
    for (int k = 0; k < edgesOfSpan; ++k) {
      const auto place = [&](int j) {
        return j == edgesOfSpan ? knots[i + 1] / length
                                : (knots[i] + (knots[i + 1] - knots[i]) * j / edgesOfSpan) / length;
      };
      outline.points.push_back(k == 0 ? points[i] : curve->at(place(k)));
      outline.labels.push_back(1);
      outline.curves.push_back({curve, place(k), place(k + 1)});
    }
  if (closed) return outline;
  outline.points.push_back(points.back());
  outline.labels.push_back(2);
  outline.curves.emplace_back();
  outline.labelNames = {{sideBehind, 2}};
  return outline;
}

TriangleMesh triangleAt(const Point& place, double size) {
  TriangleMesh mesh;
  mesh.name = "point";
  mesh.vertices = {place, place + Point(size, 0), place + Point(0, size)};
  mesh.triangles = {{0, 1, 2}};
  mesh.regions = {1};
  mesh.boundaryEdges = {{0, 1}, {1, 2}, {2, 0}};
  mesh.boundaryLabels = {1, 1, 1};
  return mesh;
}

TriangleMesh outlineMesh(const Outline& outline) {
  const auto n = static_cast<int>(outline.points.size());
  TriangleMesh mesh;
  mesh.name = outline.name;
  mesh.vertices = outline.points;
  mesh.boundaryLabels = outline.labels;
  mesh.labelNames = outline.labelNames;
  for (int k = 0; k < n; ++k) mesh.boundaryEdges.push_back({k, (k + 1) % n});
  for (size_t e = 0; e < outline.curves.size(); ++e) {
    const auto& [a, b] = mesh.boundaryEdges[e];
    const EdgeCurve& curve = outline.curves[e];
    mesh.edgeMiddles.push_back(curve.known() ? curve.at(curve.middle())
                                             : Point((mesh.vertices[a] + mesh.vertices[b]) / 2));
  }
  if (std::any_of(outline.curves.begin(), outline.curves.end(),
                  [](const auto& curve) { return curve.known(); }))
    mesh.edgeCurves = outline.curves;
  double area = 0;
  for (int k = 0; k < n; ++k) area += cross(outline.points[k], outline.points[(k + 1) % n]);
  if (!(area > 0)) throw InputError("runs clockwise, expected the body to the left of the outline");
  std::vector<int> ring(n);
  std::iota(ring.begin(), ring.end(), 0);
  // Ears beside each other in turn: the triangles of a circle have corners all around it.
  size_t k = 0;
  for (size_t failed = 0; ring.size() > 3; k = k % ring.size()) {
    if (isEar(outline.points, ring, k)) {
      const size_t m = ring.size();
      mesh.triangles.push_back({ring[(k + m - 1) % m], ring[k], ring[(k + 1) % m]});
      ring.erase(ring.begin() + static_cast<std::ptrdiff_t>(k));
      failed = 0;
    } else if (++failed > ring.size()) {
      throw InputError("crosses itself or turns back, expected a simple outline");
    }
    ++k;
  }
  mesh.triangles.push_back({ring[0], ring[1], ring[2]});
  mesh.regions.assign(mesh.triangles.size(), 0);
  validate(mesh);
  return mesh;
}

}  // namespace mortier
