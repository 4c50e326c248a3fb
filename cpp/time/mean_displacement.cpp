// Means of displacements by the nodes, exact for what the trial functions are.
#include <Eigen/Geometry>
#include <Eigen/LU>
#include <algorithm>
#include <map>

#include "base/adaptive_quadrature.h"
#include "fem/element.h"
#include "fem/tetrahedron.h"
#include "mesh/boundary_line.h"
#include "mesh/triangle_mesh.h"
#include "time/quantity.h"

namespace mortier {
namespace {

using Weights = std::vector<std::pair<int, double>>;

/// Of a quadratic triangle, where a point is that on the straight one has these coordinates: by Newton.
Barycentric onCurved(const std::array<Point, QuadraticTriangle::nodes>& x, const Point& point,
                     Barycentric b) {
  constexpr int steps = 20;
  for (int i = 0; i < steps; ++i) {
    Point off = point;
    const auto shapes = QuadraticTriangle::shapes(b);
    for (int a = 0; a < QuadraticTriangle::nodes; ++a) off -= shapes[a] * x[a];
    if (off.isZero(0)) break;
    const Point change =
        QuadraticTriangle::jacobian(QuadraticTriangle::derivatives(b), x).transpose().inverse() * off;
    b = {b[0] - change.sum(), b[1] + change.x(), b[2] + change.y()};
  }
  return b;
}

}  // namespace

Weights meanAt(const TriangleMesh& mesh, const ElementNodes& nodes, const Point& point) {
  constexpr double rounding = 1e-9;  // of a triangle: a point on the boundary is inside
  for (size_t t = 0; t < mesh.triangles.size(); ++t) {
    const auto& corners = mesh.triangles[t];
    const double area = doubleArea(mesh, static_cast<int>(t));
    Barycentric at{};
    for (int k = 0; k < 3; ++k) {
      const Point& a = mesh.vertices[corners[(k + 1) % 3]];
      const Point& b = mesh.vertices[corners[(k + 2) % 3]];
      at[k] = cross(a - point, b - point) / area;
    }
    if (!(at[0] >= -rounding && at[1] >= -rounding && at[2] >= -rounding)) continue;
    Weights weights;
    if (nodes.degree == 1) {
      for (int k = 0; k < 3; ++k) weights.emplace_back(corners[k], at[k]);
      return weights;
    }
    std::array<Point, QuadraticTriangle::nodes> x;
    for (int a = 0; a < QuadraticTriangle::nodes; ++a) x[a] = nodes.places[nodes.of(t)[a]];
    const auto shapes = QuadraticTriangle::shapes(onCurved(x, point, at));
    for (int a = 0; a < QuadraticTriangle::nodes; ++a) weights.emplace_back(nodes.of(t)[a], shapes[a]);
    return weights;
  }
  return {};
}

Weights meanOn(const TriangleMesh& mesh, const ElementNodes& nodes, int label, bool axisymmetric) {
  std::map<int, double> lengths;
  double sum = 0;
  const auto add = [&](int node, double length) {
    lengths[node] += length;
    sum += length;
  };
  for (size_t e = 0; e < mesh.boundaryEdges.size(); ++e) {
    if (mesh.boundaryLabels[e] != label) continue;
    const auto& [a, b] = mesh.boundaryEdges[e];
    if (nodes.degree == 1) {
      const double length = (mesh.vertices[b] - mesh.vertices[a]).norm();
      add(a, length / 2 * (axisymmetric ? (2 * mesh.vertices[a].x() + mesh.vertices[b].x()) / 3 : 1));
      add(b, length / 2 * (axisymmetric ? (mesh.vertices[a].x() + 2 * mesh.vertices[b].x()) / 3 : 1));
      continue;
    }
    const std::array<int, 3> numbers{a, b, nodes.middles[e]};
    const std::array<Point, 3> x{nodes.places[a], nodes.places[b], nodes.places[numbers[2]]};
    const auto radiusAt = [&](double s) {
      double radius = 0;
      for (int k = 0; k < 3; ++k) radius += QuadraticEdge::shapes(s)[k] * x[k].x();
      return radius;
    };
    const ResolvedEdge edge = resolveOnEdge([&](double s) {
      return QuadraticTriangle::edgeTangent(s, x).norm() * (axisymmetric ? radiusAt(s) : 1);
    });
    for (const auto& [s, weight, length] : edge.samples)
      for (int k = 0; k < 3; ++k) add(numbers[k], weight * length * QuadraticEdge::shapes(s)[k]);
  }
  Weights weights;
  for (const auto& [node, length] : lengths) weights.emplace_back(node, length / sum);
  return weights;
}

Weights meanAt(const TetrahedronMesh& mesh, const SpaceNodes& nodes, const SpacePoint& point) {
  constexpr double rounding = 1e-9;  // of a tetrahedron: a point on the boundary is inside
  for (size_t e = 0; e < mesh.tetrahedra.size(); ++e) {
    std::array<SpacePoint, 4> x;
    for (int k = 0; k < 4; ++k) x[k] = mesh.vertices[mesh.tetrahedra[e][k]];
    const TetrahedronGeometry geometry(x);
    SpaceBarycentric at;
    for (int k = 0; k < 4; ++k) at[k] = (k == 0 ? 1 : 0) + geometry.gradients.col(k).dot(point - x[0]);
    if (*std::min_element(at.begin(), at.end()) < -rounding) continue;
    return withSpaceElement(nodes.degree, [&](auto element) {
      Weights weights;
      const auto shapes = decltype(element)::shapes(at);
      for (size_t a = 0; a < shapes.size(); ++a) weights.emplace_back(nodes.of(e)[a], shapes[a]);
      return weights;
    });
  }
  return {};
}

// On a triangle linear functions have the mean 1/3, quadratic ones 0 at vertices and 1/3 at middles.
Weights meanOn(const TetrahedronMesh& mesh, const SpaceNodes& nodes, int label) {
  std::map<int, double> areas;
  double sum = 0;
  for (size_t i = 0; i < nodes.faces.size(); ++i) {
    if (mesh.boundaryLabels[i] != label) continue;
    const std::array<int, 6>& face = nodes.faces[i];
    const SpacePoint& x = nodes.places[face[0]];
    const double area = (nodes.places[face[1]] - x).cross(nodes.places[face[2]] - x).norm() / 2;
    for (int k = 0; k < 3; ++k) areas[face[nodes.degree == 1 ? k : 3 + k]] += area / 3;
    sum += area;
  }
  for (auto& [node, area] : areas) area /= sum;
  return {areas.begin(), areas.end()};
}

}  // namespace mortier
