// Maxwell's body and the standard linear solid on isotropic elasticity: shear relaxes, volume is elastic,
//   G(t) = G0 (g + (1 - g) exp(-t/tau)),   G0 = E/(2 (1 + nu)),
// g = 0 for Maxwell's body. By springs and a dashpot: eps = E^-1 s + eps_v,
//   2 eta eps_v' = dev s - 2 G1 eps_v,   G1 = G0 g/(1 - g),   eta = tau G0/(1 - g).
// dev is that of three dimensions, with s33 = 0 in plane stress. On directions in which E is diagonal dev s
// is d s, d = (1/3, 1, 1) on p, q, r and 1 on a deviator, so that with eps_v = eps - E^-1 s
//   G(s, eps) = (alpha s - g eps)/tau,   alpha = (1 - g) d/(2 G0) + g/e.
#pragma once

#include "material/deviatoric.h"

namespace mortier {

struct Viscoelasticity {
  double relaxationTime = 0;   ///< tau, at constant strain [s]
  double relaxedFraction = 0;  ///< g, of the shear modulus, after all time [-]
};

/// \throws InputError unless relaxationTime > 0 and 0 <= relaxedFraction < 1.
void requireValid(const Viscoelasticity& viscoelasticity);

LawDescription describe(const Elasticity& elasticity, const Viscoelasticity& viscoelasticity);

/// \tparam spring  whether g > 0  \tparam n  directions: 3, or the 5 of a deviator in space
template <bool spring, size_t n = 3>
class ViscoelasticLaw : public ElasticLaw<n> {
 public:
  using Stress = std::array<Lanes, n>;
  static constexpr bool linear = false;
  static constexpr bool needsTotalStrain = spring;

  /// \param e  eigenvalues of the elasticity tensor [Pa]  \param d  of the deviator [-]
  ViscoelasticLaw(const Pair& e, const Pair& d, const Viscoelasticity& law)
      : ElasticLaw<n>(e), tau_(law.relaxationTime), g_(law.relaxedFraction) {
    for (size_t k = 0; k < n; ++k) alpha_[k] = (1 - g_) * d[k == 0 ? 0 : 1] / e[1] + g_ / e_[k];
  }

  [[nodiscard]] double stiffness(double weight) const { return weight / tau_; }
  /// A stress of zero may still move with the strain that is left.
  template <class Scalar>
  static bool flows(const std::array<Scalar, n>& /*stress*/) {
    return true;
  }
  [[nodiscard]] Stress rate(const Stress& stress, const Stress& total) const {
    Stress rate;
    for (size_t k = 0; k < n; ++k) {
      rate[k] = alpha_[k] / tau_ * stress[k];
      if constexpr (spring) rate[k] -= g_ / tau_ * total[k];
    }
    return rate;
  }
  [[nodiscard]] PointAnswer<n> linearise(const PointStep<n>& point) const {
    Stress D;
    for (size_t k = 0; k < n; ++k) D[k] = 1 / (1 / e_[k] + point.weight * alpha_[k] / tau_);
    PointAnswer<n> answer = towardsLaw(point, D);
    for (Lanes& modulus : D) modulus *= 1 + point.weight * g_ / tau_;
    answer.moduli = diagonalMinusRankOne<n>(D, 0, {}, {});
    return answer;
  }
  /// With D = E.
  [[nodiscard]] PointAnswer<n> regularise(const PointStep<n>& point, const Lanes& /*penalty*/) const {
    Stress half;
    for (size_t k = 0; k < n; ++k) half[k] = 1 / (2 / e_[k] + point.weight * alpha_[k] / tau_);
    PointAnswer<n> answer = towardsLaw(point, half);
    answer.moduli = this->moduli();
    return answer;
  }

 private:
  /// The change D r of the stress.
  [[nodiscard]] PointAnswer<n> towardsLaw(const PointStep<n>& point, const Stress& D) const {
    const Stress flow = rate(point.stress, point.total);
    const Stress v = this->flowStrain(point);
    PointAnswer<n> answer{point.stress, {}, {}, true};
    for (size_t k = 0; k < n; ++k) {
      answer.change[k] = D[k] * (v[k] - point.weight * flow[k]);
      answer.predictor[k] += answer.change[k];
    }
    return answer;
  }

  using ElasticLaw<n>::e_;
  double tau_;
  double g_;
  std::array<double, n> alpha_;
};

/// The spring beside the dashpot is a back stress, X = 2 G1 eps_v/d: it sets 2 G1 eps_v against dev s.
template <size_t n = 3>
class StandardSolid : public ViscoelasticLaw<true, n> {
 public:
  StandardSolid(const Pair& e, const Pair& d, const Viscoelasticity& law)
      : ViscoelasticLaw<true, n>(e, d, law),
        d_(d),
        spring_(e[1] * law.relaxedFraction / (1 - law.relaxedFraction)) {}
  [[nodiscard]] std::array<Lanes, n> backStress(std::array<Lanes, n> viscoplasticStrain) const {
    for (size_t k = 0; k < n; ++k) viscoplasticStrain[k] *= spring_ / d_[k == 0 ? 0 : 1];
    return viscoplasticStrain;
  }

 private:
  Pair d_;
  double spring_;  ///< 2 G1 [Pa]
};

std::shared_ptr<const Material> viscoelasticMaterial(const Elasticity& elasticity,
                                                     const Viscoelasticity& viscoelasticity, Plane plane);

}  // namespace mortier
