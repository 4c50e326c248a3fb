// Norton creep on isotropic elasticity,
//   eps' = E^-1 sigma' + rate0 (vM/sigma0)^n (3/2) dev sigma / vM
// (F. H. Norton, The Creep of Steel at High Temperatures, 1929; in three dimensions F. K. G. Odqvist): under
// the uniaxial stress sigma0 it creeps with rate0. dev and vM are those of three dimensions, with s33 = 0 in
// plane stress, where on p, q, r
//   G = (rate0/sigma0) (vM/sigma0)^(n-1) a s,   vM^2 = a . s^2,   a = (1/2, 3/2, 3/2).
// G is the gradient of a convex function: a step minimises a convex energy.
#pragma once

#include "material/deviatoric.h"

namespace mortier {

struct NortonCreep {
  double referenceStress = 0;  ///< sigma0 [Pa]
  double referenceRate = 0;    ///< rate0, of the strain [1/s]
  double exponent = 1;         ///< n [-]
};

/// \throws InputError unless both references > 0 and exponent >= 1.
void requireValid(const NortonCreep& creep);

LawDescription describe(const Elasticity& elasticity, const NortonCreep& creep);

/// On n directions in which E and the von Mises stress are diagonal, all but the first alike: 3, or the 5 of
/// a deviator in space.
template <size_t n = 3>
class NortonLaw : public ElasticLaw<n> {
 public:
  using Stress = std::array<Lanes, n>;
  static constexpr bool linear = false;

  /// \param e  eigenvalues of the elasticity tensor [Pa]  \param a  of vM^2 [-]
  NortonLaw(const Pair& e, const Pair& a, const NortonCreep& creep);

  /// Not known without a stress.
  static double stiffness(double weight) { return weight > 0 ? 1 : 0; }
  template <class Scalar>
  [[nodiscard]] auto flows(const std::array<Scalar, n>& stress) const {
    Scalar square = stress[0] * stress[0];
    for (size_t k = 1; k < n; ++k) square += stress[k] * stress[k];
    return square > 0;
  }
  [[nodiscard]] Stress rate(const Stress& stress, const Stress& total) const;
  [[nodiscard]] PointAnswer<n> linearise(const PointStep<n>& point) const;
  [[nodiscard]] PointAnswer<n> regularise(const PointStep<n>& point, const Lanes& penalty) const;

 private:
  /// a . s^2 / sigma0^2, never quite 0.
  [[nodiscard]] Lanes square(const Stress& stress) const;
  /// Of weight (rate0/sigma0) (vM/sigma0)^(n-1) [1/Pa], where that is square(s).
  [[nodiscard]] Lanes logarithm(double weight, const Lanes& square) const;

  using ElasticLaw<n>::e_;
  std::array<double, n> a_;
  NortonCreep creep_;
};

std::shared_ptr<const Material> nortonMaterial(const Elasticity& elasticity, const NortonCreep& creep,
                                               Plane plane);

}  // namespace mortier
