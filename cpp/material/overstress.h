// Viscoplasticity of three dimensions by the overstress, with linear hardening, on isotropic elasticity
// (P. Perzyna, Adv. Appl. Mech. 9, 1966; W. Prager, 1956),
//   eps' = E^-1 sigma' + p' (3/2) dev(sigma - X)/vM,   vM = sqrt(3/2) |dev(sigma - X)|,
//   p' = rate0 (f/sigma0)^m,   f = (vM - sigma_Y - K p)_+,   X = (2/3) H eps_v.
// Without viscosity (sigma0 = 0) it is plasticity: f <= 0, p' >= 0, f p' = 0. In plane stress s33 = 0. On
// directions in which E and vM are diagonal, vM^2 = a . z^2, it is
//   eps_v' = p' a z/vM,   z = s - H eps_v/a,   eps_v = eps - E^-1 s.
// Isotropic hardening is a component rho = -K p of the stress, without strain, of the modulus K: then
// f = vM(z) + rho - sigma_Y, p' is its rate G, and a step minimises a convex energy of (s, rho).
#pragma once

#include "material/deviatoric.h"

namespace mortier {

struct Overstress {
  double yieldStress = 0;         ///< sigma_Y [Pa]
  double referenceStress = 0;     ///< sigma0, an overstress [Pa]; 0: plasticity
  double referenceRate = 1;       ///< rate0 at that, of p [1/s]
  double exponent = 1;            ///< m [-]
  double kinematicHardening = 0;  ///< H, of the uniaxial stress over the plastic strain [Pa]
  double isotropicHardening = 0;  ///< K, likewise [Pa]

  [[nodiscard]] bool viscous() const { return referenceStress > 0; }
  /// lambda of p' = f/(3 lambda): Perzyna's law of plane strain (perzyna.h) [Pa s].
  void setViscosity(double viscosity);
};

/// \throws InputError unless yieldStress, referenceRate > 0, referenceStress >= 0, exponent >= 1 and
/// hardening >= 0.
void requireValid(const Overstress& law);

LawDescription describe(const Elasticity& elasticity, const Overstress& law);

/// \throws InputError
std::shared_ptr<const Material> overstressMaterial(const Elasticity& elasticity, const Overstress& law,
                                                   Plane plane);

/// On n directions, all but the first alike: 3, or the 5 of a deviator in space. What is named `rho` is
/// nothing without isotropic hardening.
template <size_t n = 3>
class OverstressFlow {
 public:
  using Stress = std::array<Lanes, n>;
  /// \param e  eigenvalues of the elasticity tensor [Pa]  \param a  of vM^2 [-]
  OverstressFlow(const Pair& e, const Pair& a, const Overstress& law);

  struct Point {
    Stress stress, stress0, strain, total;  ///< as in PointStep
    Lanes rho0 = 0;                         ///< at the start of the step [Pa]
    Lanes strainOfRho = 0;                  ///< minus the scheme's shift [-]
    double weight = 0;
  };
  /// The law linearised: changes of the stress and rho, moduli.
  struct Answer {
    Stress change;
    Lanes rho = 0;                    ///< at the end [Pa]
    std::array<Lanes, n * n> moduli;  ///< of the stress
    Stress mixed{};                   ///< of rho and the stress
    Lanes ofRho = 0;                  ///< of rho
    bool flows = false;
  };
  [[nodiscard]] Answer linearise(const Point& point) const;
  /// As in material.h, with D^-1 = a/c - E^-1, c half of the least e a.
  [[nodiscard]] Answer regularise(const Point& point) const;
  /// a z/vM times p', and p'.
  [[nodiscard]] std::pair<Stress, Lanes> rate(const Stress& stress, const Stress& total,
                                              const Lanes& rho) const;
  [[nodiscard]] bool flows(const std::array<double, n>& stress, const std::array<double, n>& total,
                           double rho) const;
  /// H/a times the viscoplastic strain.
  [[nodiscard]] Stress backStress(const Stress& viscoplasticStrain) const;
  [[nodiscard]] double stiffness(double weight) const;
  [[nodiscard]] double elasticModulus(size_t k) const { return e_[k]; }
  [[nodiscard]] const Overstress& law() const { return law_; }

 private:
  /// The point (z, v) of the law that c a^-1 v takes to x, by the radial return
  ///   vM(z) + (c + H) dp = vM(x),   vM(z) = sigma_Y - rho + K dp + sigma0 (dp/(weight rate0))^(1/m).
  struct Return {
    LaneMask flowing;
    Stress u;     ///< a z/vM
    Lanes dp;     ///< [-]
    Lanes mises;  ///< vM(z) [Pa]
    Lanes slope;  ///< of dp over the overstress [1/Pa]
  };
  [[nodiscard]] Return radialReturn(const Stress& x, const Lanes& c, const Lanes& rho, double weight) const;
  [[nodiscard]] Lanes mises(const Stress& z) const;
  /// H/a times the viscoplastic strain at the start of the step.
  [[nodiscard]] Stress backStress(const Point& point) const;

  std::array<double, n> e_;
  std::array<double, n> a_;
  double least_;  ///< of e a [Pa]
  double onSurface_;
  Overstress law_;
};

}  // namespace mortier
