// Isotropic laws whose pressure is elastic: in plane strain, about an axis and in space. Such a law is one of
// the deviator, of three or five directions on which elasticity is the number E/(1+nu); on the pressure
// h = tr sigma/sqrt3 it is E/(1-2 nu). In the plane stresses are (p, q, r, s33) and
//   k = (p - sqrt2 s33)/sqrt3,  q,  r;   h = (sqrt2 p + s33)/sqrt3
// is an orthonormal basis as well; in space stresses are (k, q, r, sqrt2 s13, sqrt2 s23, h): the trace as a
// component of its own keeps its digits where a body flows at constant volume. For Perzyna's law all three
// projections are one: B is the von Mises cylinder, and P_B shortens the deviator to sigma_Y sqrt(2/3),
//   eps' = E^-1 sigma' + (1 - sigma_Y/vM)_+ dev sigma / (2 lambda).
#pragma once

#include <numbers>

#include "material/elasticity.h"

namespace mortier {

/// A stress or a strain; Scalar is a number or a batch of them.
template <class Scalar, size_t n = 3>
struct Split {
  std::array<Scalar, n> deviator;  ///< k, q, r, and in space sqrt2 s13, sqrt2 s23
  Scalar pressure;                 ///< h
};

/// Components of a stress whose deviator has n directions.
template <size_t n>
inline constexpr size_t withPressure = n == 5 ? 6 : 4;

inline constexpr double overRoot3 = std::numbers::inv_sqrt3;
inline constexpr double rootTwoThirds = std::numbers::sqrt2 * std::numbers::inv_sqrt3;

template <class Scalar>
Split<Scalar> split(const std::array<Scalar, 4>& s) {
  return {{overRoot3 * s[0] - rootTwoThirds * s[3], s[1], s[2]}, rootTwoThirds * s[0] + overRoot3 * s[3]};
}
template <class Scalar>
Split<Scalar, 5> split(const std::array<Scalar, 6>& s) {
  return {{s[0], s[1], s[2], s[3], s[4]}, s[5]};
}

template <class Scalar>
std::array<Scalar, 4> joined(const Split<Scalar, 3>& s) {
  return {overRoot3 * s.deviator[0] + rootTwoThirds * s.pressure, s.deviator[1], s.deviator[2],
          overRoot3 * s.pressure - rootTwoThirds * s.deviator[0]};
}
template <class Scalar>
std::array<Scalar, 6> joined(const Split<Scalar, 5>& s) {
  const std::array<Scalar, 5>& d = s.deviator;
  return {d[0], d[1], d[2], d[3], d[4], s.pressure};
}

/// Moduli D of the deviator (column major) and `bulk` of the pressure as those of the stress.
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
template <class Scalar>
std::array<Scalar, 36> joinedModuli(const std::array<Scalar, 25>& D, const Scalar& bulk) {
  std::array<Scalar, 36> all;
  all.fill(0);
  for (size_t j = 0; j < 5; ++j)
    for (size_t i = 0; i < 5; ++i) all[6 * j + i] = D[5 * j + i];
  all[35] = bulk;
  return all;
}

/// The law whose deviator follows `Law`, of three or five directions, whose pressure follows elasticity.
template <class Law>
class WithElasticPressure {
  static constexpr size_t directions = Law::components;
  static constexpr size_t n = withPressure<directions>;
  using Deviator = std::array<Lanes, directions>;

 public:
  using Stress = std::array<Lanes, n>;
  static constexpr int components = n;
  static constexpr bool linear = Law::linear;
  static constexpr bool needsTotalStrain = Law::needsTotalStrain;

  WithElasticPressure(Law deviatoric, const Elasticity& elasticity)
      : law_(std::move(deviatoric)),
        poisson_(elasticity.poisson),
        bulk_(elasticity.young / (1 - 2 * elasticity.poisson)) {}

  [[nodiscard]] bool symmetric() const { return law_.symmetric(); }
  [[nodiscard]] bool usesReturnMapping() const {
    if constexpr (requires { law_.usesReturnMapping(); }) return law_.usesReturnMapping();
    return linear;
  }
  [[nodiscard]] double stressScale() const { return law_.stressScale(); }
  [[nodiscard]] double stiffness(double weight) const { return law_.stiffness(weight); }
  [[nodiscard]] double outOfPlane(const Eigen::Vector3d& stress) const {
    return poisson_ * std::numbers::sqrt2 * stress[0];
  }
  template <class Scalar>
  [[nodiscard]] auto flows(const std::array<Scalar, n>& stress) const {
    return law_.flows(split(stress).deviator);
  }
  [[nodiscard]] Lanes penalty(const Stress& stress) const { return law_.penalty(split(stress).deviator); }
  [[nodiscard]] Stress rate(const Stress& stress, const Stress& total) const {
    return whole(law_.rate(split(stress).deviator, split(total).deviator), 0);
  }
  [[nodiscard]] Stress backStress(const Stress& viscoplasticStrain) const requires
      requires(const Law& law, const Deviator& strain) {
    law.backStress(strain);
  }
  { return whole(law_.backStress(split(viscoplasticStrain).deviator), 0); }
  [[nodiscard]] Stress elasticStrain(const Stress& stress) const {
    const auto [deviator, pressure] = split(stress);
    return whole(law_.elasticStrain(deviator), pressure / bulk_);
  }
  [[nodiscard]] PointAnswer<n> linearise(const PointStep<n>& point) const {
    return answered(point, law_.linearise(deviatorOf(point)), 1);
  }
  /// Elasticity meets the law halfway.
  [[nodiscard]] PointAnswer<n> regularise(const PointStep<n>& point, const Lanes& penalty) const {
    return answered(point, law_.regularise(deviatorOf(point), penalty), 0.5);
  }
  [[nodiscard]] ConeLaw cone(double weight) const requires requires(Law law) { law.cone(weight); }
  {
    ConeLaw cone = law_.cone(weight);
    cone.bulk = bulk_;
    return cone;
  }

 private:
  static Stress whole(const Deviator& deviator, const Lanes& pressure) {
    return joined(Split<Lanes, directions>{deviator, pressure});
  }
  static PointStep<directions> deviatorOf(const PointStep<n>& point) {
    return {split(point.stress).deviator,
            split(point.stress0).deviator,
            split(point.strain).deviator,
            split(point.total).deviator,
            point.weight,
            point.anticipate};
  }
  [[nodiscard]] PointAnswer<n> answered(const PointStep<n>& point, const PointAnswer<directions>& deviatoric,
                                        double part) const {
    const Lanes change =
        bulk_ * split(point.strain).pressure - (split(point.stress).pressure - split(point.stress0).pressure);
    PointAnswer<n> answer{point.stress, whole(deviatoric.change, part * change),
                          joinedModuli(deviatoric.moduli, Lanes(bulk_)), deviatoric.flows};
    for (size_t k = 0; k < n; ++k) answer.predictor[k] += answer.change[k];
    return answer;
  }

  Law law_;
  double poisson_;
  double bulk_;  ///< E/(1-2 nu) [Pa]
};

/// The material of an isotropic law. \param law  operator()<n>(e, a) makes it on n directions, of the
/// eigenvalues e of the elasticity tensor [Pa] and the coefficients a of the square of the von Mises stress;
/// n = 3, and 5 in space
/// \throws InputError where an elastic constant is wrong.
template <class MakeLaw>
std::shared_ptr<const Material> isotropicMaterial(const Elasticity& elasticity, Plane plane,
                                                  const LawDescription& description, const MakeLaw& law) {
  requireValid(elasticity);
  const Eigen::Array3d e = elasticity.moduli();
  if (plane == Plane::stress)
    return pointMaterial(law.template operator()<3>(Pair{e[0], e[1]}, Pair{0.5, 1.5}), description);
  const auto ofDeviator = [&]<size_t n>() {
    return pointMaterial(
        WithElasticPressure(law.template operator()<n>(Pair{e[1], e[1]}, Pair{1.5, 1.5}), elasticity),
        description);
  };
  return plane == Plane::none ? ofDeviator.template operator()<5>() : ofDeviator.template operator()<3>();
}

}  // namespace mortier
