#include "contact/space_overlap.h"

#include <algorithm>
#include <cmath>
#include <map>
#include <tuple>

namespace mortier {
namespace {

/// The nearest point of a triangle, by barycentric coordinates (Ericson, Real-Time Collision Detection,
/// section 5.1.5).
Eigen::Vector3d nearestOf(const SpacePoint& a, const SpacePoint& b, const SpacePoint& c,
                          const SpacePoint& x) {
  const SpacePoint ab = b - a, ac = c - a, ax = x - a, bx = x - b, cx = x - c;
  const double d1 = ab.dot(ax), d2 = ac.dot(ax);
  if (d1 <= 0 && d2 <= 0) return {1, 0, 0};
  const double d3 = ab.dot(bx), d4 = ac.dot(bx);
  if (d3 >= 0 && d4 <= d3) return {0, 1, 0};
  const double vc = d1 * d4 - d3 * d2;
  if (vc <= 0 && d1 >= 0 && d3 <= 0) return {1 - d1 / (d1 - d3), d1 / (d1 - d3), 0};
  const double d5 = ab.dot(cx), d6 = ac.dot(cx);
  if (d6 >= 0 && d5 <= d6) return {0, 0, 1};
  const double vb = d5 * d2 - d1 * d6;
  if (vb <= 0 && d2 >= 0 && d6 <= 0) return {1 - d2 / (d2 - d6), 0, d2 / (d2 - d6)};
  const double va = d3 * d6 - d5 * d4;
  if (va <= 0 && d4 - d3 >= 0 && d5 - d6 >= 0) {
    const double w = (d4 - d3) / ((d4 - d3) + (d5 - d6));
    return {0, 1 - w, w};
  }
  const double sum = va + vb + vc;
  return {va / sum, vb / sum, vc / sum};
}

}  // namespace

SpaceOutline outlineOf(const TetrahedronMesh& mesh, const SpaceNodes& nodes) {
  SpaceOutline outline;
  const std::vector<std::array<int, 3>> outer = outerTriangles(mesh);
  const std::vector<int> labels = labelsOf(mesh, outer);
  std::vector<char> isOuter(mesh.vertices.size(), 0);
  for (const auto& triangle : outer)
    for (const int v : triangle) isOuter[v] = 1;
  std::map<std::array<int, 2>, int> middles;
  for (size_t e = 0; e < mesh.tetrahedra.size() && nodes.degree > 1; ++e)
    for (size_t k = 0; k < sidesOfTetrahedron.size(); ++k) {
      const auto [i, j] = sidesOfTetrahedron[k];
      const int first = std::min(nodes.of(e)[i], nodes.of(e)[j]);
      const int second = std::max(nodes.of(e)[i], nodes.of(e)[j]);
      if (isOuter[first] != 0 && isOuter[second] != 0) middles[{first, second}] = nodes.of(e)[4 + k];
    }
  const auto middle = [&](int a, int b) { return middles.at({std::min(a, b), std::max(a, b)}); };
  for (size_t t = 0; t < outer.size(); ++t) {
    const auto [a, b, c] = outer[t];
    if (nodes.degree == 1) {
      outline.triangles.push_back(outer[t]);
    } else {
      const int ab = middle(a, b), bc = middle(b, c), ca = middle(c, a);
      outline.triangles.insert(outline.triangles.end(),
                               {{a, ab, ca}, {ab, b, bc}, {ca, bc, c}, {ab, bc, ca}});
    }
    outline.labels.resize(outline.triangles.size(), std::max(0, labels[t]));
  }
  std::map<std::array<int, 2>, int> sideOf;
  for (size_t t = 0; t < outline.triangles.size(); ++t)
    for (int k = 0; k < 3; ++k)
      sideOf[{outline.triangles[t][k], outline.triangles[t][(k + 1) % 3]}] = static_cast<int>(t);
  outline.around.resize(nodes.places.size());
  for (size_t t = 0; t < outline.triangles.size(); ++t) {
    for (const int node : outline.triangles[t]) outline.around[node].push_back(static_cast<int>(t));
    std::array<int, 3> neighbours{};
    for (int k = 0; k < 3; ++k) {
      const auto found = sideOf.find({outline.triangles[t][(k + 1) % 3], outline.triangles[t][k]});
      neighbours[k] = found == sideOf.end() ? static_cast<int>(t) : found->second;
    }
    outline.neighbours.push_back(neighbours);
  }
  return outline;
}

MovedSurface::MovedSurface(const SpaceOutline& outline, const std::vector<SpacePoint>& places)
    : outline_(&outline), places_(places), nodeNormals_(places.size(), SpacePoint::Zero()) {
  const auto n = static_cast<int>(outline.triangles.size());
  for (int t = 0; t < n; ++t) {
    const SpacePoint &a = corner(t, 0), &b = corner(t, 1), &c = corner(t, 2);
    normals_.push_back((b - a).cross(c - a).normalized());
    boxes_.emplace_back(a).extend(b).extend(c);
    box_.extend(boxes_.back());
    for (int k = 0; k < 3; ++k) {
      const SpacePoint to = corner(t, (k + 1) % 3) - corner(t, k);
      const SpacePoint from = corner(t, (k + 2) % 3) - corner(t, k);
      nodeNormals_[outline.triangles[t][k]] +=
          std::atan2(to.cross(from).norm(), to.dot(from)) * normals_.back();
    }
  }
  std::vector<int> numbers(n);
  for (int t = 0; t < n; ++t) numbers[t] = t;
  if (n > 0) tree_.init(numbers.begin(), numbers.end(), boxes_.begin(), boxes_.end());
}

double MovedSurface::size(int t) const {
  return std::max({(corner(t, 1) - corner(t, 0)).norm(), (corner(t, 2) - corner(t, 1)).norm(),
                   (corner(t, 0) - corner(t, 2)).norm()});
}

SpacePoint MovedSurface::middle(int t) const {
  return (corner(t, 0) + corner(t, 1) + corner(t, 2)) / 3;
}

double MovedSurface::area(int t) const {
  return (corner(t, 1) - corner(t, 0)).cross(corner(t, 2) - corner(t, 0)).norm() / 2;
}

double MovedSurface::turn(int t, int k) const {
  const int other = outline_->neighbours[t][k];
  const SpacePoint side = (corner(t, (k + 1) % 3) - corner(t, k)).normalized();
  return std::atan2(normals_[t].cross(normals_[other]).dot(side), normals_[t].dot(normals_[other]));
}

namespace {

/// For Eigen::BVMinimize: squares of distances.
struct NearestTriangle {
  const MovedSurface& surface;
  const SpacePoint& x;
  const std::vector<SpacePoint>& beside;
  double rounding;
  double least = infinity;
  int triangle = -1;
  Eigen::Vector3d weights{0, 0, 0};
  using Scalar = double;

  [[nodiscard]] double minimumOnVolume(const Eigen::AlignedBox3d& box) const {
    return box.squaredExteriorDistance(x);
  }
  double minimumOnObject(int t) {
    const Eigen::Vector3d w = nearestOf(surface.corner(t, 0), surface.corner(t, 1), surface.corner(t, 2), x);
    const SpacePoint foot =
        w[0] * surface.corner(t, 0) + w[1] * surface.corner(t, 1) + w[2] * surface.corner(t, 2);
    const double distance = (foot - x).squaredNorm();
    constexpr double parallel = 1e-9;
    if (distance <= rounding * rounding)
      for (const SpacePoint& n : beside)
        if (n.dot(surface.normal(t)) > 1 - parallel) return infinity;
    if (distance < least || (distance == least && t < triangle)) {
      least = distance;
      triangle = t;
      weights = w;
    }
    return distance;
  }
};

}  // namespace

MovedSurface::Nearest MovedSurface::nearest(const SpacePoint& x, const std::vector<SpacePoint>& beside,
                                            double rounding) const {
  if (boxes_.empty()) return {};
  NearestTriangle search{*this, x, beside, rounding};
  Eigen::BVMinimize(tree_, search);
  const int t = search.triangle;
  if (t < 0) return {};
  const Eigen::Vector3d& w = search.weights;
  const SpacePoint foot = w[0] * corner(t, 0) + w[1] * corner(t, 1) + w[2] * corner(t, 2);
  SpacePoint normal = normals_[t];
  for (int k = 0; k < 3; ++k) {
    if (w[k] == 1) normal = nodeNormals_[outline_->triangles[t][k]];
    if (w[(k + 2) % 3] == 0 && w[k] > 0 && w[(k + 1) % 3] > 0)
      normal = normals_[t] + normals_[outline_->neighbours[t][k]];
  }
  const double distance = std::sqrt(search.least);
  return {normal.dot(x - foot) < 0 ? -distance : distance, t, {w[0] > 0, w[1] > 0, w[2] > 0}, foot};
}

std::vector<int> MovedSurface::around(const Nearest& nearest) const {
  const int t = nearest.triangle;
  for (int k = 0; k < 3; ++k) {
    const bool here = nearest.with[k], next = nearest.with[(k + 1) % 3], last = nearest.with[(k + 2) % 3];
    if (here && !next && !last) return outline_->around[outline_->triangles[t][k]];
    if (here && next && !last) return {t, outline_->neighbours[t][k]};
  }
  return {t};
}

std::vector<SpacePointInside> pointsInside(const MovedSurface& one, const MovedSurface& other,
                                           double rounding) {
  std::vector<SpacePointInside> found;
  if (!one.box().intersects(other.box())) return found;
  for (const int of : {0, 1}) {
    const MovedSurface& own = of == 0 ? one : other;
    const MovedSurface& across = of == 0 ? other : one;
    std::vector<char> seen(own.places().size(), 0);
    const auto consider = [&](const SpacePoint& x, const std::vector<int>& triangles, bool node) {
      if (across.box().exteriorDistance(x) > rounding) return;
      MovedSurface::Nearest nearest = across.nearest(x);
      if (node && std::abs(nearest.distance) <= rounding) {
        // Two bodies that end in one plane, as one of symmetry, are in each other there all the same.
        std::vector<SpacePoint> normals;
        for (const int t : triangles) normals.push_back(own.normal(t));
        nearest = across.nearest(x, normals, rounding);
      }
      if (nearest.triangle < 0 || nearest.distance >= -rounding) return;
      SpacePointInside point{of,          triangles.front(), node, x, -nearest.distance, nearest.triangle,
                             nearest.foot};
      for (const int s : across.around(nearest))
        for (const int t : triangles)
          if (own.normal(t).dot(across.normal(s)) <
              own.normal(point.triangle).dot(across.normal(point.across)))
            std::tie(point.triangle, point.across) = std::pair(t, s);
      found.push_back(point);
    };
    for (size_t t = 0; t < own.outline().triangles.size(); ++t) {
      const auto triangle = static_cast<int>(t);
      consider(own.middle(triangle), {triangle}, false);
      for (const int node : own.outline().triangles[t]) {
        if (seen[node] == 0) consider(own.places()[node], own.outline().around[node], true);
        seen[node] = 1;
      }
    }
  }
  return found;
}

}  // namespace mortier
