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
  /// Values, as above, of a stress whose divergence is constant in each part, of no mean and with the couple
  /// -1: J(c - centroid), c the centroid of the part, times a factor,
  Eigen::Matrix<double, 27, 1> turn;
  Moments turnMoments;  ///< its moments,
  Eigen::Matrix<double, 2, 3>
      turnForces;  ///< and minus the integrals of its divergence and the hat functions.
  /// Of a stress without tractions on the sides that carries what a force J(x - centroid) with the couple 1
  /// is beside that: integrals of its components, and of their products.
  Stress restMean;
  Eigen::Matrix3d restEnergies;

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
