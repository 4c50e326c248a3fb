// One point in plane strain, and the same law in three-dimensional tensors.
#pragma once

#include <Eigen/Core>
#include <cmath>
#include <limits>
#include <random>

#include "material/deviatoric.h"
#include "material/stress.h"
#include "unit/one_point.h"

namespace mortier {

using Eigen::Vector4d;

constexpr double epsilon = std::numeric_limits<double>::epsilon();

struct PointLaw {
  Vector4d predictor;
  Eigen::Matrix4d moduli;  ///< what is not handed out is the symmetric rest
};

inline PointLaw take(const Linearisation& law, int point) {
  PointLaw result{law.predictor.col(point), {}};
  result.moduli.topLeftCorner<3, 3>() = Eigen::Map<const Eigen::Matrix3d>(moduliAt(law.moduli, point).data());
  result.moduli.row(3) = law.beyond.col(point).transpose();
  result.moduli.col(3) = law.beyond.col(point);
  return result;
}

inline Linearisation roomFor(Eigen::Index points) {
  return {Matrix(4, points), Matrix(6, points), Matrix(4, points)};
}

inline PointLaw lineariseAt(const Material& material, double weight, const Vector4d& s0,
                            const Vector4d& strain, const Vector4d& s, bool anticipate = false) {
  Linearisation result = roomFor(1);
  const Matrix stress0 = s0;
  const Matrix strains = strain;
  material.linearise({weight, stress0, strains, anticipate}, Matrix(s), result, 0, 1);
  return take(result, 0);
}

inline Vector4d solveAt(const Material& material, double weight, const Vector4d& s0, const Vector4d& strain,
                        Vector4d s, bool anticipate = false, int iterations = 60) {
  for (int k = 0; k < iterations; ++k) s = lineariseAt(material, weight, s0, strain, s, anticipate).predictor;
  return s;
}

inline Vector4d randomStress4(std::mt19937& random, double misesStress, double pressure) {
  std::normal_distribution<double> normal;
  Vector4d s(normal(random), normal(random), normal(random), normal(random));
  s *= misesStress / vonMises(s);
  return s + pressure * Vector4d(std::numbers::sqrt2, 0, 0, 1);
}

/// Three-dimensional tensors, in extended precision: the law as textbooks have it, step by step radial
/// return.
struct Tensors {
  using Tensor = Eigen::Matrix<Long, 3, 3>;
  Elasticity elasticity;
  Viscoplasticity flow;
  double weight = 0;

  static Tensor tensor(const Vector4d& s) {
    const Long h = std::sqrt(0.5L);
    Tensor t = Tensor::Zero();
    t(0, 0) = h * (Long(s[0]) + Long(s[1]));
    t(1, 1) = h * (Long(s[0]) - Long(s[1]));
    t(0, 1) = t(1, 0) = h * Long(s[2]);
    t(2, 2) = s[3];
    return t;
  }
  static Vector4d vector(const Tensor& t) {
    const Long h = std::sqrt(0.5L);
    return Vector4d(static_cast<double>(h * (t(0, 0) + t(1, 1))),
                    static_cast<double>(h * (t(0, 0) - t(1, 1))), static_cast<double>(2 * h * t(0, 1)),
                    static_cast<double>(t(2, 2)));
  }
  static Tensor deviator(const Tensor& t) { return t - t.trace() / 3 * Tensor::Identity(); }
  static Long mises(const Tensor& t) { return std::sqrt(1.5L) * deviator(t).norm(); }

  [[nodiscard]] Tensor stressOf(const Tensor& strain) const {
    const Long mu = elasticity.young / (2 * (1 + Long(elasticity.poisson)));
    const Long lame = 2 * mu * elasticity.poisson / (1 - 2 * Long(elasticity.poisson));
    return 2 * mu * strain + lame * strain.trace() * Tensor::Identity();
  }
  /// Trial s0 + E strain; vM + 3 mu theta (2/3 vM) (1 - sigma_Y/vM) = vM of the trial.
  [[nodiscard]] Tensor stress(const Tensor& trial) const {
    const Long mises0 = mises(trial);
    if (mises0 <= flow.yieldStress) return trial;
    const Long z = elasticity.young / (1 + Long(elasticity.poisson)) * weight / (2 * Long(flow.viscosity));
    const Long mises1 = (mises0 + z * flow.yieldStress) / (1 + z);
    return mises1 / mises0 * deviator(trial) + trial.trace() / 3 * Tensor::Identity();
  }
};

}  // namespace mortier
