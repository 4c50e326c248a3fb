// Isotropic elasticity in plane strain, and Perzyna viscoplasticity on it. Stresses are (p, q, r, s33), eps33 = 0, and B is
// the von Mises cylinder in three dimensions. Isotropic elasticity leaves pressures and deviators to themselves, and B
// knows deviators only: in the norms of all three projections P_B shortens the deviator to sigma_Y sqrt(2/3),
//   eps' = E^-1 sigma' + (1 - sigma_Y/vM)_+ dev sigma / (2 lambda).
// With the deviator and the pressure as coordinates,
//   k = (p - sqrt2 s33)/sqrt3,  q,  r;   h = (sqrt2 p + s33)/sqrt3 = tr sigma/sqrt3,
// again an orthonormal basis, elasticity is diagonal: E/(1+nu) on k, q, r and E/(1-2 nu) on h.
#pragma once

#include "material/perzyna.h"

namespace mortier {

/// What vanishes across the plane.
enum class Plane { stress, strain };

/// \throws InputError as elasticMaterial and perzynaMaterial do. The projection has no meaning.
std::shared_ptr<const Material> planeStrainElasticMaterial(const Elasticity& elasticity);
std::shared_ptr<const Material> planeStrainPerzynaMaterial(const Elasticity& elasticity,
                                                           const Viscoplasticity& viscoplasticity);

}  // namespace mortier
