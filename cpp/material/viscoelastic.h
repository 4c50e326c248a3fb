// Maxwell's body and the standard linear solid on isotropic elasticity: shear relaxes, volume is elastic,
//   G(t) = G0 (g + (1 - g) exp(-t/tau)),   G0 = E/(2 (1 + nu)),
// g = 0 for Maxwell's body. By springs and a dashpot: eps = E^-1 s + eps_v,
//   2 eta eps_v' = dev s - 2 G1 eps_v,   G1 = G0 g/(1 - g),   eta = tau G0/(1 - g).
// dev is that of three dimensions, with s33 = 0 in plane stress. On directions in which E is diagonal dev s
// is d s, d = (1/3, 1, 1) on p, q, r and 1 on a deviator, so that with eps_v = eps - E^-1 s
//   G(s, eps) = (alpha s - g eps)/tau,   alpha = (1 - g) d/(2 G0) + g/e.
#pragma once

#include "material/plane_strain.h"

namespace mortier {

struct Viscoelasticity {
  double relaxationTime = 0;   ///< tau, at constant strain [s]
  double relaxedFraction = 0;  ///< g, of the shear modulus, after all time [-]
};

/// \throws InputError unless relaxationTime > 0 and 0 <= relaxedFraction < 1.
void requireValid(const Viscoelasticity& viscoelasticity);

LawDescription describe(const Elasticity& elasticity, const Viscoelasticity& viscoelasticity);

/// \tparam spring  whether g > 0
template <bool spring>
class ViscoelasticLaw {
 public:
  static constexpr int components = 3;
  static constexpr bool linear = false;
  static constexpr bool needsTotalStrain = spring;

  /// \param e  eigenvalues of the elasticity tensor [Pa]  \param d  of the deviator [-]
  ViscoelasticLaw(const Pair& e, const Pair& d, const Viscoelasticity& law)
      : e_{e[0], e[1], e[1]}, tau_(law.relaxationTime), g_(law.relaxedFraction) {
    for (int k = 0; k < 3; ++k) alpha_[k] = (1 - g_) * d[k == 0 ? 0 : 1] / e[1] + g_ / e_[k];
  }

  static bool symmetric() { return true; }
  static double stressScale() { return 0; }
  [[nodiscard]] double stiffness(double weight) const { return weight / tau_; }
  /// A stress of zero may still move with the strain that is left.
  template <class Scalar>
  static bool flows(const std::array<Scalar, 3>& /*stress*/) {
    return true;
  }
  static Lanes penalty(const LaneVector& /*stress*/) { return 0; }
  [[nodiscard]] LaneVector rate(const LaneVector& stress, const LaneVector& total) const {
    LaneVector rate;
    for (int k = 0; k < 3; ++k) {
      rate[k] = alpha_[k] / tau_ * stress[k];
      if constexpr (spring) rate[k] -= g_ / tau_ * total[k];
    }
    return rate;
  }
  [[nodiscard]] LaneVector elasticStrain(LaneVector stress) const {
    for (int k = 0; k < 3; ++k) stress[k] *= 1 / e_[k];
    return stress;
  }
  [[nodiscard]] PointAnswer<3> linearise(const PointStep<3>& point) const {
    LaneVector D;
    for (int k = 0; k < 3; ++k) D[k] = 1 / (1 / e_[k] + point.weight * alpha_[k] / tau_);
    PointAnswer<3> answer = towardsLaw(point, D);
    for (Lanes& modulus : D) modulus *= 1 + point.weight * g_ / tau_;
    answer.moduli = diagonalMinusRankOne<3>(D, 0, {}, {});
    return answer;
  }
  /// With D = E.
  [[nodiscard]] PointAnswer<3> regularise(const PointStep<3>& point, const Lanes& /*penalty*/) const {
    LaneVector half;
    for (int k = 0; k < 3; ++k) half[k] = 1 / (2 / e_[k] + point.weight * alpha_[k] / tau_);
    PointAnswer<3> answer = towardsLaw(point, half);
    answer.moduli = diagonalMinusRankOne<3>({e_[0], e_[1], e_[2]}, 0, {}, {});
    return answer;
  }

 private:
  /// The change D r of the stress.
  [[nodiscard]] PointAnswer<3> towardsLaw(const PointStep<3>& point, const LaneVector& D) const {
    const LaneVector flow = rate(point.stress, point.total);
    PointAnswer<3> answer{point.stress, {}, {}, true};
    for (int k = 0; k < 3; ++k) {
      const Lanes elastic = (point.stress[k] - point.stress0[k]) / e_[k];
      answer.change[k] = D[k] * (point.strain[k] - elastic - point.weight * flow[k]);
      answer.predictor[k] += answer.change[k];
    }
    return answer;
  }

  double e_[3];
  double tau_;
  double g_;
  double alpha_[3];
};

/// \throws InputError
std::shared_ptr<const Material> viscoelasticMaterial(const Elasticity& elasticity,
                                                     const Viscoelasticity& viscoelasticity, Plane plane);

}  // namespace mortier
