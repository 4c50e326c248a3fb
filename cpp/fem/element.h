// Elements: where they integrate, and the gradients of their shape functions there.
#pragma once

#include <array>

#include "base/types.h"

namespace mortier {

/// Displacement linear on the triangle, strain and stress constant: one quadrature point.
struct LinearTriangle {
  static constexpr int nodes = 3;
  static constexpr int points = 1;

  struct Tabulation {
    double weight = 0;                          ///< area [m^2]
    Eigen::Matrix<double, 2, nodes> gradients;  ///< of the shape functions [1/m]; they sum to zero exactly
  };

  static Tabulation tabulate(const std::array<Point, 3>& corners) {
    const Point e1 = corners[1] - corners[0];
    const Point e2 = corners[2] - corners[0];
    const double twiceArea = e1.x() * e2.y() - e1.y() * e2.x();
    Tabulation result;
    result.weight = twiceArea / 2;
    result.gradients.col(1) = Point(e2.y(), -e2.x()) / twiceArea;
    result.gradients.col(2) = Point(-e1.y(), e1.x()) / twiceArea;
    result.gradients.col(0) = -result.gradients.col(1) - result.gradients.col(2);
    return result;
  }
};

}  // namespace mortier
