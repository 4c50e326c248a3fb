#include "material/viscoelastic.h"

namespace mortier {
void requireValid(const Viscoelasticity& viscoelasticity) {
  requireParameter(viscoelasticity.relaxationTime > 0, "relaxation_time", viscoelasticity.relaxationTime,
                   "relaxation_time > 0 [s]");
  requireParameter(viscoelasticity.relaxedFraction >= 0 && viscoelasticity.relaxedFraction < 1,
                   "relaxed_fraction", viscoelasticity.relaxedFraction, "0 <= relaxed_fraction < 1");
}

LawDescription describe(const Elasticity& elasticity, const Viscoelasticity& viscoelasticity) {
  const bool spring = viscoelasticity.relaxedFraction > 0;
  LawDescription description = describe(spring ? "standard linear solid" : "Maxwell", elasticity);
  description.parameters.push_back({"relaxation_time", viscoelasticity.relaxationTime, "s"});
  if (spring) description.parameters.push_back({"relaxed_fraction", viscoelasticity.relaxedFraction, ""});
  return description;
}

std::shared_ptr<const Material> viscoelasticMaterial(const Elasticity& elasticity,
                                                     const Viscoelasticity& viscoelasticity, Plane plane) {
  requireValid(elasticity);
  requireValid(viscoelasticity);
  const auto made = [&](const auto& law) {
    return isotropicMaterial(elasticity, plane, describe(elasticity, viscoelasticity), law);
  };
  const auto deviator = [](const Pair& a) { return Pair{a[0] / 1.5, a[1] / 1.5}; };
  if (viscoelasticity.relaxedFraction > 0)
    return made([&]<size_t n>(const Pair& e, const Pair& a) {
      return StandardSolid<n>(e, deviator(a), viscoelasticity);
    });
  return made([&]<size_t n>(const Pair& e, const Pair& a) {
    return ViscoelasticLaw<false, n>(e, deviator(a), viscoelasticity);
  });
}

}  // namespace mortier
