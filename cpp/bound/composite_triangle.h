// The composite triangle of Johnson and Mercier (1978): three parts around the centroid, in each a linear
// symmetric stress, tractions continuous between them. Where the stress has no divergence it is determined
// by its tractions on the three sides, which are linear and in equilibrium: twelve moments
//
//   m_(e,P) = integral over side e of (s n) phi_P,      P an end of e, phi_P the hat function of P,
//
// of which nine are free. A triangle with sides F = [x1 - x0, x2 - x0] and J = det F takes its stress from
// the reference triangle as s = F S F'/J, so that moments are m = F M.
#pragma once

#include <Eigen/Core>
#include <array>

#include "base/types.h"

namespace mortier {

/// Moments by sides 0-1, 1-2, 2-0, by the first and last vertex of the side, x and y [N/m].
using Moments = Eigen::Matrix<double, 12, 1>;
using MomentMatrix = Eigen::Matrix<double, 12, 12>;
/// (s11, s22, s12)
using Stress = Eigen::Vector3d;
/// A body force: its mean, and its couple about the centroid [N/m^3, N]
using BodyLoad = Eigen::Vector3d;
/// Of an Airy function: value and gradient at each corner, the mean derivatives along the outward normals of
/// the sides (Clough and Tocher's element).
using AiryModes = Eigen::Matrix<double, 12, 1>;

class CompositeTriangle {
 public:
  /// \param compliance  S with s'S s = s : E^-1 s, s = (s11, s22, s12) [1/Pa]
  CompositeTriangle(const std::array<Point, 3>& corners, const Eigen::Matrix3d& compliance);

  /// A with m'A m = integral of s : E^-1 s, s the stress with moments m in equilibrium [1/Pa].
  [[nodiscard]] MomentMatrix energy() const;
  /// The moments of a constant stress.
  [[nodiscard]] Moments momentsOf(const Stress& stress) const;
  /// Of a stress that carries a body load, constant in each part (linear without shear and 0 at the centroid
  /// for the mean, CompositeReference::turn for the couple): its moments,
  [[nodiscard]] Moments momentsOfLoad(const BodyLoad& f) const;
  /// its energy product with the stresses of moments in equilibrium, and of Airy functions,
  [[nodiscard]] Moments loadProduct(const BodyLoad& f) const;
  [[nodiscard]] AiryModes airyLoadProduct(const BodyLoad& f) const;
  /// its energy [J/m],
  [[nodiscard]] double loadEnergy(const BodyLoad& f) const;
  /// and the integrals of that force and the hat functions of the corners [N/m].
  [[nodiscard]] Eigen::Matrix<double, 2, 3> nodalForces(const BodyLoad& f) const;

  /// The energy of the stress of moments in equilibrium and of a load [J/m].
  [[nodiscard]] double energyOf(const Moments& m, const BodyLoad& f) const;

  /// The Airy function of moments in equilibrium that is 0 at the first corner, with its gradient.
  [[nodiscard]] AiryModes airyOf(const Moments& m) const;
  /// K with x'K x = integral of s : E^-1 s, s the stress of Airy modes x [1/Pa].
  [[nodiscard]] MomentMatrix airyEnergy() const;

  /// The linear force that is CompositeReference's J(x - centroid) in the reference triangle, with the couple
  /// 1: values at the corners; energy norm and integral of a stress without tractions on the sides that
  /// carries what it is beside the body load with that couple.
  [[nodiscard]] Eigen::Matrix<double, 2, 3> turningForce() const;
  [[nodiscard]] double restNorm() const;
  [[nodiscard]] Stress restMean() const;

  /// The stress of moments in equilibrium, and of a load as above, at the vertices of the parts: part e has
  /// the first and last vertex of side e and the centroid.
  [[nodiscard]] std::array<Stress, 9> stressOf(const Moments& m, const BodyLoad& f) const;

  /// The largest of: divergence, jump of tractions between the parts, and moments that are not these, of the
  /// stress with moments m; [Pa m], for tests and assertions.
  [[nodiscard]] double defect(const Moments& m) const;

 private:
  /// Components of the reference triangle by vertices of the parts.
  [[nodiscard]] Eigen::Matrix<double, 9, 3> valuesOf(const Moments& m, const BodyLoad& f) const;
  [[nodiscard]] Moments momentsInReference(const Moments& m) const;

  std::array<Point, 3> x_;
  Eigen::Matrix2d F_;
  Eigen::Matrix2d inverse_;  ///< of F
  double J_;
  Eigen::Matrix3d reference_;      ///< J P'S P, P taking (S11, S22, S12) to (s11, s22, s12)
  Eigen::Matrix3d fromReference_;  ///< P
};

/// What units of the Airy modes of a triangle do to its moments.
MomentMatrix momentsOfAiry(const std::array<Point, 3>& corners);

// The composite triangle on the reference triangle (composite_triangle.h).

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
