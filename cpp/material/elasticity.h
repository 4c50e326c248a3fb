// Isotropic elasticity on directions in which it is diagonal, all but the first alike.
#pragma once

#include "material/point_material.h"
#include "material/stress.h"
#include "material/yield_domain.h"

namespace mortier {

struct Elasticity {
  double young = 0;    ///< E [Pa]
  double poisson = 0;  ///< nu [-]
  /// Eigenvalues of plane stress on p, q, r: E/(1-nu), E/(1+nu), E/(1+nu) [Pa].
  [[nodiscard]] Eigen::Array3d moduli() const;
};

/// \throws InputError unless `holds` and the value is finite: `name = value, expected ...`.
void requireParameter(bool holds, const char* name, double value, const char* expected);
/// \throws InputError unless young > 0 and -1 < poisson < 0.5.
void requireValid(const Elasticity& elasticity);

/// "elastic", and another law, with the two constants.
LawDescription describe(const Elasticity& elasticity);
LawDescription describe(const std::string& name, const Elasticity& elasticity);

/// On n directions, all but the first alike.
template <size_t n>
std::array<double, n> onDirections(const Pair& values) {
  std::array<double, n> all;
  all.fill(values[1]);
  all[0] = values[0];
  return all;
}

/// Elasticity, and what the other isotropic laws have from it.
template <size_t n = 3>
class ElasticLaw {
 public:
  static constexpr int components = n;
  using Stress = std::array<Lanes, n>;
  static constexpr bool linear = true;
  static constexpr bool needsTotalStrain = false;

  /// \param e  eigenvalues of the elasticity tensor [Pa]
  explicit ElasticLaw(const Pair& e) : e_(onDirections<n>(e)) {}

  static bool symmetric() { return true; }
  static double stressScale() { return 0; }
  static double stiffness(double /*weight*/) { return 0; }
  template <class Scalar>
  static bool flows(const std::array<Scalar, n>& /*stress*/) {
    return false;
  }
  static Lanes penalty(const Stress& /*stress*/) { return 0; }
  static Stress rate(const Stress& /*stress*/, const Stress& /*total*/) { return {}; }
  [[nodiscard]] Stress elasticStrain(Stress stress) const {
    for (size_t k = 0; k < n; ++k) stress[k] *= 1 / e_[k];
    return stress;
  }

  [[nodiscard]] PointAnswer<n> linearise(const PointStep<n>& point) const {
    PointAnswer<n> answer{point.stress0, {}, moduli()};
    for (size_t k = 0; k < n; ++k) {
      answer.predictor[k] += e_[k] * point.strain[k];
      answer.change[k] = answer.predictor[k] - point.stress[k];
    }
    return answer;
  }
  /// D = E: the law is met halfway, and relaxation 2 is the whole way.
  [[nodiscard]] PointAnswer<n> regularise(const PointStep<n>& point, const Lanes& /*penalty*/) const {
    PointAnswer<n> answer = linearise(point);
    for (Lanes& change : answer.change) change *= 0.5;
    return answer;
  }

 protected:
  [[nodiscard]] std::array<Lanes, n * n> moduli() const {
    Stress diagonal;
    for (size_t k = 0; k < n; ++k) diagonal[k] = e_[k];
    return diagonalMinusRankOne<n>(diagonal, 0, {}, {});
  }
  /// strain - E^-1 (s - s0): the strain of the flow.
  [[nodiscard]] Stress flowStrain(const PointStep<n>& point) const {
    Stress v = point.strain;
    for (size_t k = 0; k < n; ++k) v[k] -= (point.stress[k] - point.stress0[k]) / e_[k];
    return v;
  }

  std::array<double, n> e_;
};

/// \throws InputError where a constant is wrong; so do the other materials.
std::shared_ptr<const Material> elasticMaterial(const Elasticity& elasticity, Plane plane = Plane::stress);

}  // namespace mortier
