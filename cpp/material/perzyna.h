// Isotropic elasticity in plane stress, and Perzyna viscoplasticity on it:
//   eps' = E^-1 sigma' + (sigma - P_B sigma) / (2 lambda)
// (Fernandez, Hild, Viano 2000, section 3). P_B projects on B = { von Mises <= yieldStress } in a chosen
// norm.
#pragma once

#include <memory>
#include <string>

#include "material/material.h"

namespace mortier {

/// The norm in which stresses are projected on the elastic domain B.
enum class Projection {
  elasticity,  ///< (E tau, tau), as the note prints it; the flow is not associated, the tangent not symmetric
  frobenius,   ///< tau : tau; associated, symmetric tangent, every step minimises a convex energy
  compliance   ///< (E^-1 tau, tau), the norm of Duvaut and Lions
};

struct Elasticity {
  double young = 0;    ///< E [Pa]
  double poisson = 0;  ///< nu [-]
  /// Eigenvalues of plane stress on p, q, r: E/(1-nu), E/(1+nu), E/(1+nu) [Pa].
  [[nodiscard]] Eigen::Array3d moduli() const;
};

struct Viscoplasticity {
  double viscosity = 0;    ///< lambda [Pa s]
  double yieldStress = 0;  ///< sigma_Y [Pa]
  Projection projection = Projection::frobenius;
};

/// \throws InputError unless young > 0 and -1 < poisson < 0.5, viscosity > 0 and yieldStress > 0.
void requireValid(const Elasticity& elasticity);
void requireValid(const Viscoplasticity& viscoplasticity);

/// \throws InputError unless young > 0 and -1 < poisson < 0.5 (and viscosity > 0, yieldStress > 0).
std::shared_ptr<const Material> elasticMaterial(const Elasticity& elasticity);
std::shared_ptr<const Material> perzynaMaterial(const Elasticity& elasticity,
                                                const Viscoplasticity& viscoplasticity);

}  // namespace mortier
