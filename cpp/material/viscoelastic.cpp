#include "material/viscoelastic.h"

namespace mortier {
namespace {

/// The spring beside the dashpot is a back stress, X = 2 G1 eps_v/d: it sets 2 G1 eps_v against dev s.
class StandardSolid : public ViscoelasticLaw<true> {
 public:
  StandardSolid(const Pair& e, const Pair& d, const Viscoelasticity& law)
      : ViscoelasticLaw(e, d, law), d_(d), spring_(e[1] * law.relaxedFraction / (1 - law.relaxedFraction)) {}
  [[nodiscard]] LaneVector backStress(LaneVector viscoplasticStrain) const {
    for (int k = 0; k < 3; ++k) viscoplasticStrain[k] *= spring_ / d_[k == 0 ? 0 : 1];
    return viscoplasticStrain;
  }

 private:
  Pair d_;
  double spring_;  ///< 2 G1 [Pa]
};

class StandardSolidInStrain : public InPlaneStrain<StandardSolid> {
 public:
  StandardSolidInStrain(const StandardSolid& law, const Elasticity& elasticity)
      : InPlaneStrain(law, elasticity), law_(law) {}
  [[nodiscard]] Stress backStress(const Stress& viscoplasticStrain) const {
    return joined(Split<Lanes>{law_.backStress(split(viscoplasticStrain).deviator), 0});
  }

 private:
  StandardSolid law_;
};

template <class Law, class LawInStrain>
std::shared_ptr<const Material> make(const Elasticity& elasticity, const Viscoelasticity& viscoelasticity,
                                     Plane plane) {
  const Eigen::Array3d e = elasticity.moduli();
  LawDescription description = describe(elasticity, viscoelasticity);
  if (plane == Plane::stress)
    return pointMaterial(Law({e[0], e[1]}, {1.0 / 3, 1}, viscoelasticity), std::move(description));
  return pointMaterial(LawInStrain(Law({e[1], e[1]}, {1, 1}, viscoelasticity), elasticity),
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
  using Maxwell = ViscoelasticLaw<false>;
  return viscoelasticity.relaxedFraction > 0
             ? make<StandardSolid, StandardSolidInStrain>(elasticity, viscoelasticity, plane)
             : make<Maxwell, InPlaneStrain<Maxwell>>(elasticity, viscoelasticity, plane);
}

}  // namespace mortier
