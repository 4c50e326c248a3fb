// The law of overstress.h in the planes and in space, with what its hardening needs: the total strain, a
// component rho.
#include "material/overstress.h"

namespace mortier {
namespace {

/// \tparam tensor  components of the stress  \tparam kinematic, isotropic  whether it hardens like that
template <int tensor, bool kinematic, bool isotropic>
class OverstressLaw {
 public:
  static constexpr int remembered = isotropic ? 1 : 0;
  static constexpr size_t directions = tensor == 6 ? 5 : 3;  ///< of the flow
  static constexpr int components = tensor + remembered;
  static constexpr bool linear = false;
  static constexpr bool needsTotalStrain = kinematic;
  static bool usesReturnMapping() { return true; }
  using Stress = std::array<Lanes, components>;
  using Numbers = std::array<double, components>;

  using Flow = OverstressFlow<directions>;
  template <class Scalar>
  using Parts = Split<Scalar, directions>;

  OverstressLaw(const Flow& flow, const Elasticity& elasticity)
      : flow_(flow),
        poisson_(elasticity.poisson),
        bulk_(elasticity.young / (1 - 2 * elasticity.poisson)),
        K_(flow.law().isotropicHardening) {}

  static bool symmetric() { return true; }
  [[nodiscard]] double stressScale() const { return flow_.law().yieldStress; }
  [[nodiscard]] double stiffness(double weight) const { return flow_.stiffness(weight); }
  static Lanes penalty(const Stress& /*stress*/) { return 0; }
  [[nodiscard]] double outOfPlane(const Eigen::Vector3d& stress) const {
    return poisson_ * std::numbers::sqrt2 * stress[0];
  }
  [[nodiscard]] bool flows(const Numbers& stress) const requires(!kinematic) {
    return flow_.flows(parts(stress).deviator, {}, rhoOf(stress));
  }
  [[nodiscard]] bool flows(const Numbers& stress, const Numbers& total) const requires kinematic {
    return flow_.flows(parts(stress).deviator, parts(total).deviator, rhoOf(stress));
  }
  [[nodiscard]] Stress backStress(const Stress& viscoplasticStrain) const requires kinematic {
    return whole({flow_.backStress(parts(viscoplasticStrain).deviator), 0}, 0);
  }
  [[nodiscard]] Stress rate(const Stress& stress, const Stress& total) const {
    const auto [rate, p] = flow_.rate(parts(stress).deviator, parts(total).deviator, rhoOf(stress));
    return whole({rate, 0}, p);
  }
  [[nodiscard]] Stress elasticStrain(const Stress& stress) const {
    Parts<Lanes> s = parts(stress);
    for (size_t k = 0; k < directions; ++k) s.deviator[k] *= 1 / flow_.elasticModulus(k);
    s.pressure *= 1 / bulk_;
    return whole(s, isotropic ? rhoOf(stress) / K_ : Lanes(0));
  }
  [[nodiscard]] PointAnswer<components> linearise(const PointStep<components>& point) const {
    return answered(point, flow_.linearise(own(point)), 1);
  }
  /// Elasticity, and what it remembers, meet the law halfway.
  [[nodiscard]] PointAnswer<components> regularise(const PointStep<components>& point,
                                                   const Lanes& /*penalty*/) const {
    return answered(point, flow_.regularise(own(point)), 0.5);
  }

 private:
  static constexpr bool hasPressure = tensor > directions;

  template <class Scalar>
  static Parts<Scalar> parts(const std::array<Scalar, components>& s) {
    std::array<Scalar, tensor> all;
    std::copy_n(s.begin(), tensor, all.begin());
    if constexpr (hasPressure)
      return split(all);
    else
      return {all, 0};
  }
  template <class Scalar>
  static Scalar rhoOf(const std::array<Scalar, components>& s) {
    if constexpr (isotropic) return s[tensor];
    return 0;
  }
  static Stress whole(const Parts<Lanes>& s, const Lanes& rho) {
    Stress all;
    const auto stress = [&] {
      if constexpr (hasPressure)
        return joined(s);
      else
        return s.deviator;
    }();
    std::copy(stress.begin(), stress.end(), all.begin());
    if constexpr (isotropic) all[tensor] = rho;
    return all;
  }
  static typename Flow::Point own(const PointStep<components>& point) {
    std::array<Lanes, directions> total{};
    if constexpr (kinematic) total = parts(point.total).deviator;
    return {parts(point.stress).deviator,
            parts(point.stress0).deviator,
            parts(point.strain).deviator,
            total,
            rhoOf(point.stress0),
            rhoOf(point.strain),
            point.weight};
  }
  [[nodiscard]] PointAnswer<components> answered(const PointStep<components>& point,
                                                 const typename Flow::Answer& answer, double part) const {
    Lanes pressure = 0;
    if constexpr (hasPressure)
      pressure = part * (bulk_ * parts(point.strain).pressure - parts(point.stress).pressure +
                         parts(point.stress0).pressure);
    PointAnswer<components> all;
    all.flows = answer.flows;
    all.predictor = point.stress;
    all.change = whole({answer.change, pressure}, isotropic ? part * (answer.rho - rhoOf(point.stress)) : 0);
    for (size_t k = 0; k < components; ++k) all.predictor[k] += all.change[k];
    constexpr size_t n = components;
    constexpr size_t t = tensor;
    const auto moduli = [&] {
      if constexpr (hasPressure)
        return joinedModuli(answer.moduli, Lanes(bulk_));
      else
        return answer.moduli;
    }();
    for (size_t j = 0; j < t; ++j)
      for (size_t i = 0; i < t; ++i) all.moduli[n * j + i] = moduli[t * j + i];
    if constexpr (isotropic) {
      const Stress mixed = whole({answer.mixed, 0}, answer.ofRho);
      for (size_t k = 0; k < n; ++k) all.moduli[n * t + k] = all.moduli[n * k + t] = mixed[k];
    }
    return all;
  }

  Flow flow_;
  double poisson_;
  double bulk_;  ///< E/(1-2 nu) [Pa]
  double K_;
};

template <int tensor>
std::shared_ptr<const Material> make(const OverstressFlow<tensor == 6 ? 5 : 3>& flow,
                                     const Elasticity& elasticity) {
  LawDescription description = describe(elasticity, flow.law());
  if (flow.law().isotropicHardening > 0)
    return pointMaterial(OverstressLaw<tensor, true, true>(flow, elasticity), std::move(description));
  if (flow.law().kinematicHardening > 0)
    return pointMaterial(OverstressLaw<tensor, true, false>(flow, elasticity), std::move(description));
  return pointMaterial(OverstressLaw<tensor, false, false>(flow, elasticity), std::move(description));
}

}  // namespace

std::shared_ptr<const Material> overstressMaterial(const Elasticity& elasticity, const Overstress& law,
                                                   Plane plane) {
  requireValid(elasticity);
  requireValid(law);
  const Eigen::Array3d e = elasticity.moduli();
  if (plane == Plane::stress) return make<3>(OverstressFlow<3>({e[0], e[1]}, {0.5, 1.5}, law), elasticity);
  if (plane == Plane::none) return make<6>(OverstressFlow<5>({e[1], e[1]}, {1.5, 1.5}, law), elasticity);
  return make<4>(OverstressFlow<3>({e[1], e[1]}, {1.5, 1.5}, law), elasticity);
}

}  // namespace mortier
