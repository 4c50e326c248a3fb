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

std::shared_ptr<const Material> spaceNortonMaterial(const Elasticity& elasticity, const NortonCreep& creep) {
  requireValid(elasticity);
  requireValid(creep);
  const NortonLaw<5> law(onDeviator(elasticity), {1.5, 1.5}, creep);
  return pointMaterial(InSpace(law, elasticity), describe(elasticity, creep));
}

std::shared_ptr<const Material> spaceViscoelasticMaterial(const Elasticity& elasticity,
                                                          const Viscoelasticity& viscoelasticity) {
  requireValid(elasticity);
  requireValid(viscoelasticity);
  LawDescription description = describe(elasticity, viscoelasticity);
  const auto made = [&](const auto& law) { return pointMaterial(InSpace(law, elasticity), description); };
  if (viscoelasticity.relaxedFraction > 0)
    return made(StandardSolid<5>(onDeviator(elasticity), {1, 1}, viscoelasticity));
  return made(ViscoelasticLaw<false, 5>(onDeviator(elasticity), {1, 1}, viscoelasticity));
}

}  // namespace mortier
