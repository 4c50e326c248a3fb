#include "material/plane_strain.h"

namespace mortier {
namespace {

/// On k, q, r, where E is one number.
Pair shear(const Elasticity& elasticity) {
  const double e = elasticity.young / (1 + elasticity.poisson);
  return {e, e};
}

}  // namespace

std::shared_ptr<const Material> planeStrainElasticMaterial(const Elasticity& elasticity) {
  requireValid(elasticity);
  return pointMaterial(InPlaneStrain(ElasticLaw(shear(elasticity)), elasticity), describe(elasticity));
}

std::shared_ptr<const Material> planeStrainPerzynaMaterial(const Elasticity& elasticity,
                                                           const Viscoplasticity& viscoplasticity) {
  requireValid(elasticity);
  requireValid(viscoplasticity);
  const PerzynaLaw law(shear(elasticity), {1.5, 1.5}, {1, 1}, viscoplasticity);
  return pointMaterial(InPlaneStrain(law, elasticity), describe(elasticity, viscoplasticity));
}

}  // namespace mortier
