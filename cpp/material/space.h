// Isotropic laws in space. Stresses and strains are (k, q, r, sqrt2 s13, sqrt2 s23, h), with the deviator of
// plane strain (plane_strain.h), two shears more, and the pressure h = tr sigma/sqrt3 last: an orthonormal
// basis in which elasticity is diagonal, E/(1+nu) on the deviator and E/(1-2 nu) on h. That the trace is a
// component of its own keeps its digits where a body flows at constant volume.
#pragma once

#include "material/norton.h"
#include "material/overstress.h"
#include "material/perzyna.h"
#include "material/viscoelastic.h"

namespace mortier {

/// The law whose deviator follows `Law`, of five components, whose pressure follows elasticity.
template <class Law>
class InSpace {
 public:
  using Stress = std::array<Lanes, 6>;
  using Deviator = std::array<Lanes, 5>;
  static constexpr int components = 6;
  static constexpr bool linear = Law::linear;
  static constexpr bool needsTotalStrain = Law::needsTotalStrain;

  InSpace(Law deviatoric, const Elasticity& elasticity)
      : law_(std::move(deviatoric)), bulk_(elasticity.young / (1 - 2 * elasticity.poisson)) {}

  [[nodiscard]] bool symmetric() const { return law_.symmetric(); }
  [[nodiscard]] double stressScale() const { return law_.stressScale(); }
  [[nodiscard]] double stiffness(double weight) const { return law_.stiffness(weight); }
  template <class Scalar>
  [[nodiscard]] auto flows(const std::array<Scalar, 6>& stress) const {
    return law_.flows(deviator(stress));
  }
  [[nodiscard]] Lanes penalty(const Stress& stress) const { return law_.penalty(deviator(stress)); }
  [[nodiscard]] Stress rate(const Stress& stress, const Stress& total) const {
    return whole(law_.rate(deviator(stress), deviator(total)), 0);
  }
  [[nodiscard]] Stress backStress(const Stress& viscoplasticStrain) const requires
      requires(const Law& law, const Deviator& strain) {
    law.backStress(strain);
  }
  { return whole(law_.backStress(deviator(viscoplasticStrain)), 0); }
  [[nodiscard]] Stress elasticStrain(const Stress& stress) const {
    return whole(law_.elasticStrain(deviator(stress)), stress[5] / bulk_);
  }
  [[nodiscard]] PointAnswer<6> linearise(const PointStep<6>& point) const {
    return joined(point, law_.linearise(deviatorOf(point)), 1);
  }
  /// Elasticity meets the law halfway.
  [[nodiscard]] PointAnswer<6> regularise(const PointStep<6>& point, const Lanes& penalty) const {
    return joined(point, law_.regularise(deviatorOf(point), penalty), 0.5);
  }

 private:
  template <class Scalar>
  static std::array<Scalar, 5> deviator(const std::array<Scalar, 6>& s) {
    return {s[0], s[1], s[2], s[3], s[4]};
  }
  static Stress whole(const Deviator& d, const Lanes& pressure) {
    return {d[0], d[1], d[2], d[3], d[4], pressure};
  }
  static PointStep<5> deviatorOf(const PointStep<6>& point) {
    return {deviator(point.stress), deviator(point.stress0), deviator(point.strain), deviator(point.total),
            point.weight,           point.anticipate};
  }
  [[nodiscard]] PointAnswer<6> joined(const PointStep<6>& point, const PointAnswer<5>& deviatoric,
                                      double part) const {
    const Lanes change = bulk_ * point.strain[5] - (point.stress[5] - point.stress0[5]);
    PointAnswer<6> answer{point.stress, whole(deviatoric.change, part * change), {}, deviatoric.flows};
    for (size_t k = 0; k < 6; ++k) answer.predictor[k] += answer.change[k];
    answer.moduli.fill(0);
    for (size_t j = 0; j < 5; ++j)
      for (size_t i = 0; i < 5; ++i) answer.moduli[6 * j + i] = deviatoric.moduli[5 * j + i];
    answer.moduli[35] = bulk_;
    return answer;
  }

  Law law_;
  double bulk_;  ///< E/(1-2 nu) [Pa]
};

/// \throws InputError as elasticMaterial and perzynaMaterial do. The projection has no meaning.
std::shared_ptr<const Material> spaceElasticMaterial(const Elasticity& elasticity);
std::shared_ptr<const Material> spacePerzynaMaterial(const Elasticity& elasticity,
                                                     const Viscoplasticity& viscoplasticity);
/// \throws InputError as the materials of the plane do.
std::shared_ptr<const Material> spaceNortonMaterial(const Elasticity& elasticity, const NortonCreep& creep);
std::shared_ptr<const Material> spaceViscoelasticMaterial(const Elasticity& elasticity,
                                                          const Viscoelasticity& viscoelasticity);
std::shared_ptr<const Material> spaceOverstressMaterial(const Elasticity& elasticity, const Overstress& law);

}  // namespace mortier
