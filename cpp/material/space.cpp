#include "material/space.h"

namespace mortier {
namespace {

/// On the deviator, where E is one number.
Pair onDeviator(const Elasticity& elasticity) {
  const double e = elasticity.young / (1 + elasticity.poisson);
  return {e, e};
}

}  // namespace

std::shared_ptr<const Material> spaceElasticMaterial(const Elasticity& elasticity) {
  requireValid(elasticity);
  return pointMaterial(InSpace(ElasticLaw<5>(onDeviator(elasticity)), elasticity), describe(elasticity));
}

std::shared_ptr<const Material> spacePerzynaMaterial(const Elasticity& elasticity,
                                                     const Viscoplasticity& viscoplasticity) {
  requireValid(elasticity);
  requireValid(viscoplasticity);
  const PerzynaLaw<5> law(onDeviator(elasticity), {1.5, 1.5}, {1, 1}, viscoplasticity);
  return pointMaterial(InSpace(law, elasticity), describe(elasticity, viscoplasticity));
}

}  // namespace mortier
