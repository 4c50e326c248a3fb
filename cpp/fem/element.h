// Elements: nodes, shape functions, where they integrate, and the gradients there. Kernels are written once,
// for `Element::nodes` and `Element::points`, and compiled for each (withElement).
#pragma once

#include <array>
#include <cmath>
#include <numbers>

#include <Eigen/LU>

#include "base/quadrature_rules.h"
#include "base/types.h"
#include "mesh/element_nodes.h"

namespace mortier {

inline constexpr double overRoot2 = std::numbers::sqrt2 / 2;

using Barycentric = std::array<double, 3>;

/// A point of a rule on the triangle, in parts of the area; and what its value gives to each node of an
/// element.
template <int n>
struct LoadPoint {
  Barycentric at;
  std::array<double, n> toNode;
};

/// The same on an edge, at a part of its length.
template <int n>
struct EdgePoint {
  double at;
  std::array<double, n> toNode;
};

/// Of an element at its quadrature points.
template <int nodes, int points, int dim = 2>
struct Tabulation {
  std::array<double, points> weights{};                             ///< their sum is the area [m^2]
  std::array<Eigen::Matrix<double, dim, nodes>, points> gradients;  ///< [1/m]; they sum to zero
  std::array<Eigen::Vector<double, dim>, points> places;            ///< [m]
};

/// Displacement linear on the triangle, strain and stress constant: one quadrature point.
struct LinearTriangle {
  static constexpr int nodes = 3;
  static constexpr int points = 1;
  static constexpr int edgeNodes = 2;
  static constexpr bool straight = true;  ///< its sides
  static constexpr std::array<Barycentric, points> interior{{{1.0 / 3, 1.0 / 3, 1.0 / 3}}};

  static Tabulation<nodes, points> tabulate(const std::array<Point, nodes>& x) {
    const Point e1 = x[1] - x[0];
    const Point e2 = x[2] - x[0];
    const double twiceArea = cross(e1, e2);
    Tabulation<nodes, points> result;
    result.weights[0] = twiceArea / 2;
    auto& gradients = result.gradients[0];
    gradients.col(1) = Point(e2.y(), -e2.x()) / twiceArea;
    gradients.col(2) = Point(-e1.y(), e1.x()) / twiceArea;
    gradients.col(0) = -gradients.col(1) - gradients.col(2);
    result.places[0] = (x[0] + x[1] + x[2]) / 3;
    return result;
  }

  // Loads: sums over these over the divisor, exact for data of these degrees; on edges Simpson's rule.
  static constexpr int edgeExact = 2;
  static constexpr int loadExact = 1;
  static constexpr double edgeDivisor = 6;
  static constexpr std::array<EdgePoint<2>, 3> edgeRule() {
    return {{{0, {1, 0}}, {0.5, {2, 2}}, {1, {0, 1}}}};
  }
  static constexpr double loadDivisor = 6;
  static constexpr std::array<LoadPoint<3>, 3> loadRule() {
    return {{{{0.5, 0.5, 0}, {1, 1, 0}}, {{0, 0.5, 0.5}, {0, 1, 1}}, {{0.5, 0, 0.5}, {1, 0, 1}}}};
  }

  static constexpr std::array<double, nodes> shapes(const Barycentric& b) { return b; }
  static constexpr std::array<double, edgeNodes> edgeShapes(double s) { return LinearEdge::shapes(s); }
  /// A stress by its values at the points.
  static constexpr std::array<double, points> stressShapes(const Barycentric& /*b*/) { return {1}; }
  /// dx/ds
  static Point edgeTangent(double /*s*/, const std::array<Point, edgeNodes>& x) { return x[1] - x[0]; }
  /// By which the weights of a rule are multiplied at a point.
  static double areaAt(const Barycentric& /*at*/, const std::array<Point, nodes>& x) {
    return tabulate(x).weights[0];
  }
};

/// Displacement quadratic on a triangle with straight or curved sides (isoparametric); stress at three
/// interior points. Nodes: the vertices, then the middles of the sides 0-1, 1-2, 2-0.
struct QuadraticTriangle {
  static constexpr int nodes = 6;
  static constexpr int points = 3;
  static constexpr int edgeNodes = 3;
  static constexpr bool straight = false;

  static constexpr std::array<double, nodes> shapes(const Barycentric& b) {
    return {b[0] * (2 * b[0] - 1), b[1] * (2 * b[1] - 1), b[2] * (2 * b[2] - 1),
            4 * b[0] * b[1],       4 * b[1] * b[2],       4 * b[2] * b[0]};
  }
  /// Of the ends, then the middle.
  static constexpr std::array<double, edgeNodes> edgeShapes(double s) { return QuadraticEdge::shapes(s); }
  static constexpr std::array<double, points> stressShapes(const Barycentric& b) {
    return {2 * b[0] - 1.0 / 3, 2 * b[1] - 1.0 / 3, 2 * b[2] - 1.0 / 3};
  }
  /// By the second and third barycentric coordinate.
  static Eigen::Matrix<double, 2, nodes> derivatives(const Barycentric& b) {
    Eigen::Matrix<double, 2, nodes> d;
    d << 1 - 4 * b[0], 4 * b[1] - 1, 0, 4 * (b[0] - b[1]), 4 * b[2], -4 * b[2],  //
        1 - 4 * b[0], 0, 4 * b[2] - 1, -4 * b[1], 4 * b[1], 4 * (b[0] - b[2]);
    return d;
  }

  static Point edgeTangent(double s, const std::array<Point, edgeNodes>& x) {
    return (x[1] - x[0]) + 4 * (1 - 2 * s) * (x[2] - (x[0] + x[1]) / 2);
  }
  static double areaAt(const Barycentric& at, const std::array<Point, nodes>& x) {
    return jacobian(derivatives(at), x).determinant() / 2;
  }

  /// Rows: the derivatives of the place.
  static Eigen::Matrix2d jacobian(const Eigen::Matrix<double, 2, nodes>& d,
                                  const std::array<Point, nodes>& x) {
    Eigen::Matrix2d J = Eigen::Matrix2d::Zero();
    for (int a = 1; a < nodes; ++a) J += d.col(a) * (x[a] - x[0]).transpose();
    return J;
  }

  static constexpr std::array<Barycentric, points> interior{
      {{2.0 / 3, 1.0 / 6, 1.0 / 6}, {1.0 / 6, 2.0 / 3, 1.0 / 6}, {1.0 / 6, 1.0 / 6, 2.0 / 3}}};

  static Tabulation<nodes, points> tabulate(const std::array<Point, nodes>& x) {
    Tabulation<nodes, points> result;
    for (int q = 0; q < points; ++q) {
      const Eigen::Matrix<double, 2, nodes> d = derivatives(interior[q]);
      const Eigen::Matrix2d J = jacobian(d, x);
      result.weights[q] = J.determinant() / 6;
      result.gradients[q] = J.inverse() * d;
      const std::array<double, nodes> N = shapes(interior[q]);
      result.places[q] = Point::Zero();
      for (int a = 0; a < nodes; ++a) result.places[q] += N[a] * x[a];
    }
    return result;
  }

  // On edges Gauss, three points, on straight triangles Dunavant (1985), degree 4.
  static constexpr int edgeExact = 3;
  static constexpr int loadExact = 2;
  static constexpr double edgeDivisor = 1;
  static constexpr EdgePoint<3> gauss(const EdgePlace& place) {
    const auto [s, w] = place;
    const auto [a, b, m] = edgeShapes(s);
    return {s, {w * a, w * b, w * m}};
  }
  static constexpr std::array<EdgePoint<3>, 3> edgeRule() {
    return {{gauss(gaussThree[0]), gauss(gaussThree[1]), gauss(gaussThree[2])}};
  }
  static constexpr double loadDivisor = 1;
  static constexpr std::array<LoadPoint<6>, 6> loadRule() {
    std::array<LoadPoint<6>, 6> rule{};
    for (int i = 0; i < 6; ++i) {
      const auto& [b, w] = dunavantSix[i];
      const std::array<double, nodes> N = shapes(b);
      rule[i] = {b, {w * N[0], w * N[1], w * N[2], w * N[3], w * N[4], w * N[5]}};
    }
    return rule;
  }
};

/// Calls work(Element{}) with the element of a degree.
template <class Work>
decltype(auto) withElement(int degree, Work work) {
  return degree == 1 ? work(LinearTriangle{}) : work(QuadraticTriangle{});
}

}  // namespace mortier
