// Shape functions on an edge of an element, and numbers of its nodes: the two ends, then the middle.
#pragma once

#include <array>

#include "base/types.h"

namespace mortier {

struct LinearEdge {
  static constexpr std::array<double, 2> shapes(double xi) { return {1 - xi, xi}; }
};

struct QuadraticEdge {
  static constexpr std::array<double, 3> shapes(double xi) {
    return {(1 - xi) * (1 - 2 * xi), xi * (2 * xi - 1), 4 * xi * (1 - xi)};
  }
};

/// One value a node of an edge: two or three.
using EdgeValues = Eigen::Matrix<double, Eigen::Dynamic, 1, 0, 3, 1>;
using EdgeNodes = Eigen::Matrix<int, Eigen::Dynamic, 1, 0, 3, 1>;

/// \param xi  part of the edge from its first end
inline EdgeValues edgeShapes(int degree, double xi) {
  if (degree == 1) return EdgeValues{{1 - xi, xi}};
  const auto [a, b, middle] = QuadraticEdge::shapes(xi);
  return EdgeValues{{a, b, middle}};
}

}  // namespace mortier
