#include "material/plane_strain.h"

namespace mortier {
namespace {

/// On k, q, r, where E is one number.
Pair shear(const Elasticity& elasticity) {
  const double e = elasticity.young / (1 + elasticity.poisson);
  return {e, e};
}

template <size_t n>
std::shared_ptr<const Material> elasticDeviator(const Elasticity& elasticity) {
  requireValid(elasticity);
  return pointMaterial(InPlaneStrain(ElasticLaw<n>(shear(elasticity)), elasticity), describe(elasticity));
}

template <size_t n>
std::shared_ptr<const Material> perzynaDeviator(const Elasticity& elasticity,
                                                const Viscoplasticity& viscoplasticity) {
  requireValid(elasticity);
  requireValid(viscoplasticity);
  const PerzynaLaw<n> law(shear(elasticity), {1.5, 1.5}, {1, 1}, viscoplasticity);
  return pointMaterial(InPlaneStrain(law, elasticity), describe(elasticity, viscoplasticity));
}

}  // namespace

std::shared_ptr<const Material> planeStrainElasticMaterial(const Elasticity& elasticity) {
  return elasticDeviator<3>(elasticity);
}

std::shared_ptr<const Material> planeStrainPerzynaMaterial(const Elasticity& elasticity,
                                                           const Viscoplasticity& viscoplasticity) {
  return perzynaDeviator<3>(elasticity, viscoplasticity);
}

std::shared_ptr<const Material> spaceElasticMaterial(const Elasticity& elasticity) {
  return elasticDeviator<5>(elasticity);
}

std::shared_ptr<const Material> spacePerzynaMaterial(const Elasticity& elasticity,
                                                     const Viscoplasticity& viscoplasticity) {
  return perzynaDeviator<5>(elasticity, viscoplasticity);
}

}  // namespace mortier
