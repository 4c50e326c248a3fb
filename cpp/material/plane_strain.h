// Isotropic laws in plane strain. Stresses are (p, q, r, s33), eps33 = 0. With the deviator and the pressure
// as coordinates,
//   k = (p - sqrt2 s33)/sqrt3,  q,  r;   h = (sqrt2 p + s33)/sqrt3 = tr sigma/sqrt3,
// again an orthonormal basis, to which space adds the two shears across the plane, elasticity is diagonal: E/(1+nu) on k, q, r and E/(1-2 nu) on h. A law that
// leaves the pressure to elasticity is one of the deviator. For Perzyna's that is so in the norms of all
// three projections: B is the von Mises cylinder, and P_B shortens the deviator to sigma_Y sqrt(2/3),
//   eps' = E^-1 sigma' + (1 - sigma_Y/vM)_+ dev sigma / (2 lambda).
#pragma once

#include <numbers>

#include "material/perzyna.h"

namespace mortier {

/// What is zero across the plane; of bodies that turn about the axis x = 0 nothing is: the fourth strain is
/// that of the circumference.
enum class Plane { stress, strain, axisymmetric };

/// A stress or a strain; Scalar is a number or a batch of them.
template <class Scalar, size_t n = 3>
struct Split {
  std::array<Scalar, n> deviator;  ///< k, q, r, and in space the two shears across the plane
  Scalar pressure;                 ///< h
};

inline constexpr double overRoot3 = std::numbers::inv_sqrt3;
inline constexpr double rootTwoThirds = std::numbers::sqrt2 * std::numbers::inv_sqrt3;

/// Of (p, q, r, s33), in space with two shears more.
template <class Scalar, size_t n>
Split<Scalar, n - 1> split(const std::array<Scalar, n>& s) {
  Split<Scalar, n - 1> result;
  result.deviator[0] = overRoot3 * s[0] - rootTwoThirds * s[3];
  for (size_t k = 1; k < n - 1; ++k) result.deviator[k] = s[k < 3 ? k : k + 1];
  result.pressure = rootTwoThirds * s[0] + overRoot3 * s[3];
  return result;
}

template <class Scalar, size_t n>
std::array<Scalar, n + 1> joined(const Split<Scalar, n>& s) {
  std::array<Scalar, n + 1> result;
  result[0] = overRoot3 * s.deviator[0] + rootTwoThirds * s.pressure;
  for (size_t k = 1; k < n; ++k) result[k < 3 ? k : k + 1] = s.deviator[k];
  result[3] = overRoot3 * s.pressure - rootTwoThirds * s.deviator[0];
  return result;
}

/// Moduli D of the deviator (n x n, column major) and `bulk` of the pressure as those of the stress.
template <size_t n = 3, class Scalar>
std::array<Scalar, (n + 1) * (n + 1)> joinedModuli(const std::array<Scalar, n * n>& D, const Scalar& bulk) {
  constexpr size_t all = n + 1;
  std::array<Scalar, all * all> H;
  const Scalar mixed = overRoot3 * rootTwoThirds * (bulk - D[0]);
  H[0] = D[0] / 3 + 2 * bulk / 3;
  H[3] = H[3 * all] = mixed;
  H[3 * all + 3] = bulk / 3 + 2 * D[0] / 3;
  for (size_t j = 1; j < n; ++j) {
    const size_t at = j < 3 ? j : j + 1;
    H[at] = overRoot3 * D[j];
    H[3 * all + at] = -rootTwoThirds * D[j];
    H[all * at] = overRoot3 * D[n * j];
    H[all * at + 3] = -rootTwoThirds * D[n * j];
    for (size_t i = 1; i < n; ++i) H[all * at + (i < 3 ? i : i + 1)] = D[n * j + i];
  }
  return H;
}

/// The law whose deviator follows `Law`, whose pressure follows elasticity: in plane strain, or in space where
/// the deviator has five components.
template <class Law>
class InPlaneStrain {
 public:
  static constexpr size_t n = Law::components + 1;
  using Stress = std::array<Lanes, n>;
  static constexpr int components = n;
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
  [[nodiscard]] auto flows(const std::array<Scalar, n>& stress) const {
    return law_.flows(split(stress).deviator);
  }
  [[nodiscard]] Lanes penalty(const Stress& stress) const { return law_.penalty(split(stress).deviator); }
  [[nodiscard]] Stress rate(const Stress& stress, const Stress& total) const {
    return joined(Split<Lanes, n - 1>{law_.rate(split(stress).deviator, split(total).deviator), 0});
  }
  [[nodiscard]] Stress elasticStrain(const Stress& stress) const {
    const auto [deviator, pressure] = split(stress);
    return joined(Split<Lanes, n - 1>{law_.elasticStrain(deviator), pressure / bulk_});
  }
  [[nodiscard]] PointAnswer<n> linearise(const PointStep<n>& point) const {
    return whole(point, law_.linearise(deviatorOf(point)), 1);
  }
  /// Elasticity meets the law halfway.
  [[nodiscard]] PointAnswer<n> regularise(const PointStep<n>& point, const Lanes& penalty) const {
    return whole(point, law_.regularise(deviatorOf(point), penalty), 0.5);
  }
  [[nodiscard]] ConeLaw cone(double weight) const requires requires(Law law) { law.cone(weight); }
  {
    ConeLaw cone = law_.cone(weight);
    cone.bulk = bulk_;
    return cone;
  }

 private:
  static PointStep<n - 1> deviatorOf(const PointStep<n>& point) {
    return {split(point.stress).deviator,
            split(point.stress0).deviator,
            split(point.strain).deviator,
            split(point.total).deviator,
            point.weight,
            point.anticipate};
  }
  [[nodiscard]] PointAnswer<n> whole(const PointStep<n>& point, const PointAnswer<n - 1>& deviatoric,
                                     double part) const {
    const Lanes change =
        bulk_ * split(point.strain).pressure - (split(point.stress).pressure - split(point.stress0).pressure);
    PointAnswer<n> answer{point.stress, joined(Split<Lanes, n - 1>{deviatoric.change, part * change}),
                          joinedModuli<n - 1>(deviatoric.moduli, Lanes(bulk_)), deviatoric.flows};
    for (size_t k = 0; k < n; ++k) answer.predictor[k] += answer.change[k];
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
/// The same in space.
std::shared_ptr<const Material> spaceElasticMaterial(const Elasticity& elasticity);
std::shared_ptr<const Material> spacePerzynaMaterial(const Elasticity& elasticity,
                                                     const Viscoplasticity& viscoplasticity);

}  // namespace mortier
