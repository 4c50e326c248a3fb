// Perzyna viscoplasticity on isotropic elasticity,
//   eps' = E^-1 sigma' + (sigma - P_B sigma) / (2 lambda)
// (Fernandez, Hild, Viano 2000, section 3). P_B projects on B = { von Mises <= yieldStress } in a chosen
// norm.
#pragma once

#include "material/elasticity.h"

namespace mortier {

/// The norm in which stresses are projected on the elastic domain B.
enum class Projection {
  elasticity,  ///< (E tau, tau), as the note prints it; the flow is not associated, the tangent not symmetric
  frobenius,   ///< tau : tau; associated, symmetric tangent, every step minimises a convex energy
  compliance   ///< (E^-1 tau, tau), the norm of Duvaut and Lions
};
inline constexpr const char* projectionNames[] = {"elasticity", "frobenius", "compliance"};

struct Viscoplasticity {
  double viscosity = 0;    ///< lambda [Pa s]
  double yieldStress = 0;  ///< sigma_Y [Pa]
  Projection projection = Projection::frobenius;
};

/// \throws InputError unless viscosity > 0 and yieldStress > 0.
void requireValid(const Viscoplasticity& viscoplasticity);

LawDescription describe(const Elasticity& elasticity, const Viscoplasticity& viscoplasticity);

/// On n directions in which E, B and the norm are diagonal, all but the first alike: 3, or the 5 of a
/// deviator in space.
template <size_t n = 3>
class PerzynaLaw : public ElasticLaw<n> {
 public:
  using Stress = std::array<Lanes, n>;
  static constexpr bool linear = false;

  /// \param e  eigenvalues of the elasticity tensor [Pa]  \param a, w  of the yield function and the norm [-]
  PerzynaLaw(const Pair& e, const Pair& a, const Pair& w, const Viscoplasticity& law);

  [[nodiscard]] bool symmetric() const { return symmetric_; }
  [[nodiscard]] bool usesReturnMapping() const { return symmetric_; }
  [[nodiscard]] double stressScale() const { return law_.yieldStress; }
  [[nodiscard]] double stiffness(double weight) const { return theta(weight) * std::max(e_[0], e_[1]); }
  template <class Scalar>
  [[nodiscard]] auto flows(const std::array<Scalar, n>& stress) const {
    return domain_.yields(stress);
  }
  [[nodiscard]] Lanes penalty(const Stress& stress) const;
  [[nodiscard]] Stress rate(const Stress& stress, const Stress& total) const;
  [[nodiscard]] PointAnswer<n> linearise(const PointStep<n>& point) const;
  [[nodiscard]] PointAnswer<n> regularise(const PointStep<n>& point, const Lanes& penalty) const;
  [[nodiscard]] ConeLaw cone(double weight) const requires(n == 3);

 private:
  [[nodiscard]] double theta(double weight) const { return weight / (2 * law_.viscosity); }

  using ElasticLaw<n>::e_;
  Pair a_;
  Pair w_;
  Viscoplasticity law_;
  bool symmetric_;
  YieldDomain<double> domain_;
};

/// The projection has a meaning in plane stress only.
std::shared_ptr<const Material> perzynaMaterial(const Elasticity& elasticity,
                                                const Viscoplasticity& viscoplasticity,
                                                Plane plane = Plane::stress);

}  // namespace mortier
