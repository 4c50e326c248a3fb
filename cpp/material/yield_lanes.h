// YieldDomain (yield_domain.h) for eight stresses at once. Every norm here weighs q and r alike, so the multiplier
// depends on a . s^2 through two numbers only, those of p and of (q, r).
#pragma once

#include "material/law_lanes.h"

namespace mortier {

/// ProjectionOnYield, lane by lane; the entries of q and r where they are the same are held once.
struct LaneProjection {
  LaneVector overstress;
  std::array<Lanes, 2> softening;
  std::array<Lanes, 2> stretch;
  LaneVector x;
  LaneVector y;
  Lanes z;
};

class YieldLanes {
 public:
  /// \param weight  of the norm on p, relative to that on q and r.
  YieldLanes(double yieldStress, double weight)
      : scale_(1 / yieldStress), a_{0.5, 1.5}, b_{0.5 / weight, 1.5} {}

  [[nodiscard]] LaneMask yields(const LaneVector& s) const {
    constexpr double onSurface = 1 - 1e-10;
    const auto [p, q] = square(s);
    return p + q >= onSurface;
  }

  /// Lanes outside `flowing` get the projection with m = 0.
  [[nodiscard]] LaneProjection project(const LaneVector& t, const Lanes& kappa,
                                       const LaneMask& flowing) const {
    const Lanes m = multiplier(t, flowing);
    LaneProjection result;
    result.z = 0;
    for (int i = 0; i < 3; ++i) {
      const int j = i == 0 ? 0 : 1;
      const Lanes mb = m * b_[j];
      const Lanes both = 1 / ((1 + mb) * (1 + kappa * mb));
      const Lanes c = (1 + kappa * mb) * both;
      const Lanes k = (1 + mb) * both;
      result.overstress[i] = mb * c * t[i];
      result.softening[j] = mb * k;
      result.stretch[j] = (1 + mb) * k;
      result.x[i] = t[i] * b_[j] * c * k;
      result.y[i] = t[i] * a_[j] * c * k;
      result.z += a_[j] * b_[j] * (t[i] * c) * (t[i] * c) * k;
    }
    return result;
  }

 private:
  /// The parts of p and of (q, r) in a . s^2 / sigma_Y^2.
  [[nodiscard]] std::array<Lanes, 2> square(const LaneVector& s) const {
    const Lanes p = s[0] * scale_;
    const Lanes q = s[1] * scale_;
    const Lanes r = s[2] * scale_;
    return {a_[0] * p * p, a_[1] * (q * q + r * r)};
  }

  /// Newton's method as in YieldDomain::multiplier, on a common denominator: with d = 1 + m b, psi is
  ///   d_p d_q / sqrt(p d_q^2 + q d_p^2).
  /// A lane that has arrived stays, so no lane depends on its neighbours.
  [[nodiscard]] Lanes multiplier(const LaneVector& t, LaneMask climbing) const {
    constexpr double last = 1e-9;
    const auto [p, q] = square(t);
    Lanes m = 0;
    for (int iteration = 0; iteration < 60; ++iteration) {
      const Lanes dp = 1 + m * b_[0];
      const Lanes dq = 1 + m * b_[1];
      const Lanes P = p * dq * dq;
      const Lanes Q = q * dp * dp;
      const Lanes slope = P * dq * b_[0] + Q * dp * b_[1];
      const Lanes step = (P + Q) * (sqrt(P + Q) - dp * dq) / slope;
      climbing = climbing && step > 0;
      where(climbing, m) += step;
      climbing = climbing && step > last * m;
      if (none_of(climbing)) break;
    }
    return m;
  }

  double scale_;
  double a_[2];
  double b_[2];
};

}  // namespace mortier
