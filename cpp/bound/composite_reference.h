// The composite triangle on the reference triangle (composite_triangle.h).
#pragma once

#include "bound/composite_triangle.h"

namespace mortier {

const std::array<Point, 3> referenceCorners{Point(0, 0), Point(1, 0), Point(0, 1)};

struct CompositeReference {
  /// Values of the stress with given moments, by components; of each at the vertices of the parts: part e has
  /// side e, its first and last vertex, and the centroid.
  Eigen::Matrix<double, 27, 12> stresses;
  Eigen::Matrix<double, 9, 9> mass;  ///< integrals of products, all three parts
  /// Of components a, b = 00, 11, 22, 01, 02, 12: the energy of moments by a coefficient,
  std::array<MomentMatrix, 6> energies;
  std::array<MomentMatrix, 6> airyEnergies;  ///< the same by Airy modes
  Eigen::Matrix<double, 30, 12> defects;     ///< what is off in the stress of moments

  CompositeReference();
};

const CompositeReference& compositeReference();

/// Outward normal times length of the way from a to b, the body to its left.
inline Point acrossFrom(const Point& a, const Point& b) {
  return {b.y() - a.y(), -(b.x() - a.x())};
}

/// (s n) for s = (s11, s22, s12), as a matrix on s.
inline Eigen::Matrix<double, 2, 3> tractionMatrix(const Point& n) {
  Eigen::Matrix<double, 2, 3> result;
  result << n.x(), 0, n.y(), 0, n.y(), n.x();
  return result;
}

}  // namespace mortier
