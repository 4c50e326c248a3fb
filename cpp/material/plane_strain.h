// Isotropic laws in plane strain. Stresses are (p, q, r, s33), eps33 = 0. With the deviator and the pressure
// as coordinates,
//   k = (p - sqrt2 s33)/sqrt3,  q,  r;   h = (sqrt2 p + s33)/sqrt3 = tr sigma/sqrt3,
// again an orthonormal basis, elasticity is diagonal: E/(1+nu) on k, q, r and E/(1-2 nu) on h. A law that
// leaves the pressure to elasticity is one of the deviator. For Perzyna's that is so in the norms of all
// three projections: B is the von Mises cylinder, and P_B shortens the deviator to sigma_Y sqrt(2/3),
//   eps' = E^-1 sigma' + (1 - sigma_Y/vM)_+ dev sigma / (2 lambda).
#pragma once

#include <numbers>

#include "material/perzyna.h"

namespace mortier {

/// What is zero across the plane; of bodies that turn about the axis x = 0 nothing is: the fourth strain is
/// that of the circumference. None: of bodies in space.
enum class Plane { stress, strain, axisymmetric, none };

/// A stress or a strain; Scalar is a number or a batch of them.
template <class Scalar, size_t n = 3>
struct Split {
  std::array<Scalar, n> deviator;  ///< k, q, r
  Scalar pressure;                 ///< h
};

inline constexpr double overRoot3 = std::numbers::inv_sqrt3;
inline constexpr double rootTwoThirds = std::numbers::sqrt2 * std::numbers::inv_sqrt3;

template <class Scalar>
Split<Scalar> split(const std::array<Scalar, 4>& s) {
  return {{overRoot3 * s[0] - rootTwoThirds * s[3], s[1], s[2]}, rootTwoThirds * s[0] + overRoot3 * s[3]};
}

template <class Scalar>
std::array<Scalar, 4> joined(const Split<Scalar>& s) {
  return {overRoot3 * s.deviator[0] + rootTwoThirds * s.pressure, s.deviator[1], s.deviator[2],
          overRoot3 * s.pressure - rootTwoThirds * s.deviator[0]};
}

/// Moduli D of the deviator (3 x 3, column major) and `bulk` of the pressure as those of (p, q, r, s33).
template <class Scalar>
std::array<Scalar, 16> joinedModuli(const std::array<Scalar, 9>& D, const Scalar& bulk) {
  const Scalar mixed = overRoot3 * rootTwoThirds * (bulk - D[0]);
  return {D[0] / 3 + 2 * bulk / 3,
          overRoot3 * D[1],
          overRoot3 * D[2],
          mixed,  //
          overRoot3 * D[3],
          D[4],
          D[5],
          -rootTwoThirds * D[3],  //
          overRoot3 * D[6],
          D[7],
          D[8],
          -rootTwoThirds * D[6],  //
          mixed,
          -rootTwoThirds * D[1],
          -rootTwoThirds * D[2],
          bulk / 3 + 2 * D[0] / 3};
}

/// The law whose deviator follows `Law`, whose pressure follows elasticity.
template <class Law>
class InPlaneStrain {
 public:
  using Stress = std::array<Lanes, 4>;
  static constexpr int components = 4;
  static constexpr bool linear = Law::linear;
  static constexpr bool needsTotalStrain = Law::needsTotalStrain;

  InPlaneStrain(Law deviatoric, const Elasticity& elasticity)
      : law_(std::move(deviatoric)),
        poisson_(elasticity.poisson),
        bulk_(elasticity.young / (1 - 2 * elasticity.poisson)) {}

  [[nodiscard]] bool symmetric() const { return law_.symmetric(); }
  [[nodiscard]] double stressScale() const { return law_.stressScale(); }
  [[nodiscard]] double stiffness(double weight) const { return law_.stiffness(weight); }
  [[nodiscard]] double outOfPlane(const Eigen::Vector3d& stress) const {
    return poisson_ * std::numbers::sqrt2 * stress[0];
  }
  template <class Scalar>
  [[nodiscard]] auto flows(const std::array<Scalar, 4>& stress) const {
    return law_.flows(split(stress).deviator);
  }
  [[nodiscard]] Lanes penalty(const Stress& stress) const { return law_.penalty(split(stress).deviator); }
  [[nodiscard]] Stress rate(const Stress& stress, const Stress& total) const {
    return joined(Split<Lanes>{law_.rate(split(stress).deviator, split(total).deviator), 0});
  }
  [[nodiscard]] Stress backStress(const Stress& viscoplasticStrain) const requires
      requires(const Law& law, const LaneVector& strain) {
    law.backStress(strain);
  }
  { return joined(Split<Lanes>{law_.backStress(split(viscoplasticStrain).deviator), 0}); }
  [[nodiscard]] Stress elasticStrain(const Stress& stress) const {
    const auto [deviator, pressure] = split(stress);
    return joined(Split<Lanes>{law_.elasticStrain(deviator), pressure / bulk_});
  }
  [[nodiscard]] PointAnswer<4> linearise(const PointStep<4>& point) const {
    return whole(point, law_.linearise(deviatorOf(point)), 1);
  }
  /// Elasticity meets the law halfway.
  [[nodiscard]] PointAnswer<4> regularise(const PointStep<4>& point, const Lanes& penalty) const {
    return whole(point, law_.regularise(deviatorOf(point), penalty), 0.5);
  }
  [[nodiscard]] ConeLaw cone(double weight) const requires requires(Law law) { law.cone(weight); }
  {
    ConeLaw cone = law_.cone(weight);
    cone.bulk = bulk_;
    return cone;
  }

 private:
  static PointStep<3> deviatorOf(const PointStep<4>& point) {
    return {split(point.stress).deviator,
            split(point.stress0).deviator,
            split(point.strain).deviator,
            split(point.total).deviator,
            point.weight,
            point.anticipate};
  }
  [[nodiscard]] PointAnswer<4> whole(const PointStep<4>& point, const PointAnswer<3>& deviatoric,
                                     double part) const {
    const Lanes change =
        bulk_ * split(point.strain).pressure - (split(point.stress).pressure - split(point.stress0).pressure);
    PointAnswer<4> answer{point.stress, joined(Split<Lanes>{deviatoric.change, part * change}),
                          joinedModuli(deviatoric.moduli, Lanes(bulk_)), deviatoric.flows};
    for (int k = 0; k < 4; ++k) answer.predictor[k] += answer.change[k];
    return answer;
  }

  Law law_;
  double poisson_;
  double bulk_;  ///< E/(1-2 nu) [Pa]
};

/// \throws InputError as elasticMaterial and perzynaMaterial do. The projection has no meaning.
std::shared_ptr<const Material> planeStrainElasticMaterial(const Elasticity& elasticity);
std::shared_ptr<const Material> planeStrainPerzynaMaterial(const Elasticity& elasticity,
                                                           const Viscoplasticity& viscoplasticity);

}  // namespace mortier
