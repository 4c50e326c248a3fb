// Elements in space as in fem/element.h: nodes, shape functions, where they integrate, and the gradients.
#pragma once

#include <array>
#include <cmath>
#include <numbers>
#include <vector>

#include <Eigen/LU>

#include "base/types.h"
#include "fem/element.h"
#include "mesh/tetrahedron_mesh.h"

namespace mortier {

using SpaceBarycentric = std::array<double, 4>;

/// Gradients of the barycentric coordinates, as columns [1/m], and the volume [m^3].
struct TetrahedronGeometry {
  explicit TetrahedronGeometry(const std::array<SpacePoint, 4>& x) {
    Eigen::Matrix3d edges;
    edges << x[1] - x[0], x[2] - x[0], x[3] - x[0];
    volume = edges.determinant() / 6;
    gradients.rightCols<3>() = edges.inverse().transpose();
    gradients.col(0) = -gradients.rightCols<3>().rowwise().sum();
  }
  Eigen::Matrix<double, 3, 4> gradients;
  double volume;
};

/// At the points of an element with straight sides. \param x  of its nodes, the vertices first [m]
template <class Element>
Tabulation<Element::nodes, Element::points, 3> tabulated(const std::array<SpacePoint, Element::nodes>& x) {
  Tabulation<Element::nodes, Element::points, 3> result;
  const TetrahedronGeometry geometry({x[0], x[1], x[2], x[3]});
  for (int q = 0; q < Element::points; ++q) {
    const SpaceBarycentric& at = Element::interior[q];
    result.weights[q] = geometry.volume / Element::points;
    result.gradients[q] = geometry.gradients * Element::derivatives(at);
    result.places[q] = at[0] * x[0] + at[1] * x[1] + at[2] * x[2] + at[3] * x[3];
  }
  return result;
}

/// Displacement linear on the tetrahedron, strain and stress constant.
struct LinearTetrahedron {
  static constexpr int nodes = 4;
  static constexpr int points = 1;
  static constexpr std::array<SpaceBarycentric, points> interior{{{0.25, 0.25, 0.25, 0.25}}};
  static constexpr std::array<double, nodes> shapes(const SpaceBarycentric& b) { return b; }
  /// Rows: derivatives by the barycentric coordinates.
  static Eigen::Matrix<double, 4, nodes> derivatives(const SpaceBarycentric& /*b*/) {
    return Eigen::Matrix4d::Identity();
  }
};

/// Displacement quadratic on a tetrahedron with straight sides, stress linear: four points.
struct QuadraticTetrahedron {
  static constexpr int nodes = 10;
  static constexpr int points = 4;
  static constexpr double near = 0.5854101966249685, far = 0.1381966011250105;
  static constexpr std::array<SpaceBarycentric, points> interior{
      {{near, far, far, far}, {far, near, far, far}, {far, far, near, far}, {far, far, far, near}}};
  static std::array<double, nodes> shapes(const SpaceBarycentric& b) {
    std::array<double, nodes> N;
    for (int k = 0; k < 4; ++k) N[k] = b[k] * (2 * b[k] - 1);
    for (int k = 0; k < 6; ++k) N[4 + k] = 4 * b[sidesOfTetrahedron[k][0]] * b[sidesOfTetrahedron[k][1]];
    return N;
  }
  static Eigen::Matrix<double, 4, nodes> derivatives(const SpaceBarycentric& b) {
    Eigen::Matrix<double, 4, nodes> d = Eigen::Matrix<double, 4, nodes>::Zero();
    for (int k = 0; k < 4; ++k) d(k, k) = 4 * b[k] - 1;
    for (int k = 0; k < 6; ++k) {
      const auto [i, j] = sidesOfTetrahedron[k];
      d(i, 4 + k) = 4 * b[j];
      d(j, 4 + k) = 4 * b[i];
    }
    return d;
  }
};

/// Calls work(Element{}) with the element of a degree.
template <class Work>
decltype(auto) withSpaceElement(int degree, Work work) {
  return degree == 1 ? work(LinearTetrahedron{}) : work(QuadraticTetrahedron{});
}

// With G = gradient / sqrt2, a displacement (x, y, z) of a node strains by
//   k: (Gx x + Gy y - 2 Gz z)/sqrt3,  q: Gx x - Gy y,  r: Gy x + Gx y,
//   13: Gz x + Gx z,  23: Gz y + Gy z,  h: sqrt(2/3) (Gx x + Gy y + Gz z).
using NodeStrain = Eigen::Matrix<double, 6, 3>;
inline NodeStrain strainOfNode(double gx, double gy, double gz) {
  constexpr double third = std::numbers::inv_sqrt3;
  constexpr double trace = std::numbers::sqrt2 * std::numbers::inv_sqrt3;
  NodeStrain B;
  B << third * gx, third * gy, -2 * third * gz,  //
      gx, -gy, 0,                                //
      gy, gx, 0,                                 //
      gz, 0, gx,                                 //
      0, gz, gy,                                 //
      trace * gx, trace * gy, trace * gz;
  return B;
}

/// The sum of strainOfNode times the displacements, from H = sum of displacement times G'.
inline Eigen::Vector<double, 6> strainOfGradient(const Eigen::Matrix3d& H) {
  constexpr double third = std::numbers::inv_sqrt3;
  constexpr double trace = std::numbers::sqrt2 * std::numbers::inv_sqrt3;
  const double sum = H(0, 0) + H(1, 1);
  return {third * (sum - 2 * H(2, 2)), H(0, 0) - H(1, 1), H(0, 1) + H(1, 0),
          H(0, 2) + H(2, 0),           H(1, 2) + H(2, 1), trace * (sum + H(2, 2))};
}

/// T with T G = strainOfNode(G)' s.
inline Eigen::Matrix3d tensorOfStress(const Eigen::Vector<double, 6>& s) {
  const double k = std::numbers::inv_sqrt3 * s[0];
  const double h = std::numbers::sqrt2 * std::numbers::inv_sqrt3 * s[5];
  return Eigen::Matrix3d{{k + s[1] + h, s[2], s[3]}, {s[2], k - s[1] + h, s[4]}, {s[3], s[4], h - 2 * k}};
}

/// A point of a rule on the unit triangle or tetrahedron, the weights adding up to its size.
struct SpaceRulePoint {
  SpacePoint at;
  double weight = 0;
};
/// Conical products of Gauss's rule of four points, exact for polynomials of degree 6 and 5.
std::vector<SpaceRulePoint> triangleRule();
std::vector<SpaceRulePoint> tetrahedronRule();

}  // namespace mortier
