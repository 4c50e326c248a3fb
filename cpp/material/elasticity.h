// Isotropic elasticity on three directions in which it is diagonal, the last two alike.
#pragma once

#include "material/point_material.h"
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

class ElasticLaw {
 public:
  static constexpr int components = 3;
  static constexpr bool linear = true;
  static constexpr bool needsTotalStrain = false;

  /// \param e  eigenvalues of the elasticity tensor [Pa]
  explicit ElasticLaw(const Pair& e) : e_{e[0], e[1], e[1]} {}

  static bool symmetric() { return true; }
  static double stressScale() { return 0; }
  static double stiffness(double /*weight*/) { return 0; }
  template <class Scalar>
  static bool flows(const std::array<Scalar, 3>& /*stress*/) {
    return false;
  }
  static Lanes penalty(const LaneVector& /*stress*/) { return 0; }
  static LaneVector rate(const LaneVector& /*stress*/, const LaneVector& /*total*/) { return {}; }
  [[nodiscard]] LaneVector elasticStrain(LaneVector stress) const {
    for (int k = 0; k < 3; ++k) stress[k] *= 1 / e_[k];
    return stress;
  }

  [[nodiscard]] PointAnswer<3> linearise(const PointStep<3>& point) const {
    PointAnswer<3> answer{point.stress0, {}, diagonalMinusRankOne({e_[0], e_[1], e_[2]}, 0, {}, {})};
    for (int k = 0; k < 3; ++k) {
      answer.predictor[k] += e_[k] * point.strain[k];
      answer.change[k] = answer.predictor[k] - point.stress[k];
    }
    return answer;
  }
  /// D = E: the law is met halfway, and relaxation 2 is the whole way.
  [[nodiscard]] PointAnswer<3> regularise(const PointStep<3>& point, const Lanes& /*penalty*/) const {
    PointAnswer<3> answer = linearise(point);
    for (Lanes& change : answer.change) change *= 0.5;
    return answer;
  }

 private:
  double e_[3];
};

/// In plane stress.
std::shared_ptr<const Material> elasticMaterial(const Elasticity& elasticity);

}  // namespace mortier
