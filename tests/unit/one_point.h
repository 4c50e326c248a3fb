// The viscoplastic law at one point.
#pragma once

#include <random>

#include "material/perzyna.h"
#include "material/stress.h"

namespace mortier {

using Eigen::Vector3d;
using Long = long double;
using LongArray = Eigen::Array<Long, 3, 1>;

constexpr Projection projections[] = {Projection::elasticity, Projection::frobenius, Projection::compliance};

struct Answer {
  Vector3d predictor;
  Eigen::Matrix3d moduli;
};

inline Answer linearise(const Material& material, double weight, const Vector3d& s0, const Vector3d& strain,
                        const Vector3d& s, bool anticipate = false) {
  Linearisation result{Matrix(3, 1), Matrix(9, 1)};
  const Matrix stress0 = s0;
  const Matrix strains = strain;
  const MaterialStep step{weight, stress0, strains, anticipate};
  material.linearise(step, Matrix(s), result, 0, 1);
  return {result.predictor.col(0), Eigen::Map<const Eigen::Matrix3d>(result.moduli.data())};
}

/// The stress at the end of a step with a given strain, by Newton's method from `s`.
inline Vector3d solve(const Material& material, double weight, const Vector3d& s0, const Vector3d& strain,
                      Vector3d s, bool anticipate = false, int iterations = 60) {
  for (int k = 0; k < iterations; ++k) s = linearise(material, weight, s0, strain, s, anticipate).predictor;
  return s;
}

inline Vector3d randomStress(std::mt19937& random, double misesStress) {
  std::normal_distribution<double> normal;
  const Vector3d s(normal(random), normal(random), normal(random));
  return s * (misesStress / vonMises(s));
}

/// The law at one point, in extended precision and solved for the stress: with the trial t = s0 + E strain,
///   P_i = t_i / (1 + m b_i (1 + theta e_i)),  s_i = P_i (1 + m b_i),  m the root of a . P^2 = sigma_Y^2.
struct Law {
  Elasticity elasticity;
  Viscoplasticity viscoplasticity;
  double weight = 0;

  [[nodiscard]] LongArray e() const { return elasticity.moduli().cast<Long>(); }
  [[nodiscard]] Long theta() const { return Long(weight) / (2 * Long(viscoplasticity.viscosity)); }
  [[nodiscard]] LongArray b() const {
    const LongArray a(0.5L, 1.5L, 1.5L);
    if (viscoplasticity.projection == Projection::elasticity) return a * e()[1] / e();
    if (viscoplasticity.projection == Projection::compliance) return a * e() / e()[1];
    return a;
  }

  /// The root m of |v / (1 + m c)| = sigma_Y, by bisection.
  [[nodiscard]] Long multiplier(const LongArray& v, const LongArray& c) const {
    const auto beyond = [&](Long m) {
      const LongArray P = v / (1 + m * c) / Long(viscoplasticity.yieldStress);
      return 0.5L * P[0] * P[0] + 1.5L * (P[1] * P[1] + P[2] * P[2]) > 1;
    };
    if (!beyond(0)) return 0;
    Long low = 0;
    Long high = 1e-20L;
    while (beyond(high)) high *= 16;
    for (int k = 0; k < 140; ++k) (beyond((low + high) / 2) ? low : high) = (low + high) / 2;
    return high;
  }

  [[nodiscard]] LongArray stress(const LongArray& trial) const {
    const LongArray c = b() * (1 + theta() * e());
    const Long m = multiplier(trial, c);
    return trial / (1 + m * c) * (1 + m * b());
  }

  /// The trial that leads to stress s.
  [[nodiscard]] LongArray trialOf(const LongArray& s) const {
    const Long m = multiplier(s, b());
    return s / (1 + m * b()) * (1 + m * b() * (1 + theta() * e()));
  }
};

}  // namespace mortier
