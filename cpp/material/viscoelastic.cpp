#include "material/viscoelastic.h"

namespace mortier {
namespace {

template <class Law>
std::shared_ptr<const Material> make(const Elasticity& elasticity, const Viscoelasticity& viscoelasticity,
                                     Plane plane) {
  const Eigen::Array3d e = elasticity.moduli();
  LawDescription description = describe(elasticity, viscoelasticity);
  if (plane == Plane::stress)
    return pointMaterial(Law({e[0], e[1]}, {1.0 / 3, 1}, viscoelasticity), std::move(description));
  return pointMaterial(InPlaneStrain(Law({e[1], e[1]}, {1, 1}, viscoelasticity), elasticity),
                       std::move(description));
}

}  // namespace

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
  return viscoelasticity.relaxedFraction > 0
             ? make<StandardSolid<>>(elasticity, viscoelasticity, plane)
             : make<ViscoelasticLaw<false>>(elasticity, viscoelasticity, plane);
}

}  // namespace mortier
