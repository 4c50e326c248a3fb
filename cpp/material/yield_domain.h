// The elastic domain B = { a . s^2 <= sigma_Y^2 } and the projection on it in a norm with weights w,
//   (P_B s)_i = s_i / (1 + m b_i),  b_i = a_i / w_i,  m >= 0 the root of  a . (P_B s)^2 = sigma_Y^2,
// for eight stresses at once. a = (1/2, 3/2, 3/2) on p, q, r is von Mises in plane stress; (3/2, 3/2, 3/2) on
// a deviator is von Mises in three dimensions, of five components in space. Every norm here weighs all
// directions but the first alike.
#pragma once

#include "material/law_lanes.h"

namespace mortier {

/// The first direction, and the others.
using Pair = std::array<double, 2>;

/// The flow theta (t - P_B t) at a stress t on or beyond yield, and how it changes, free of cancellation. The
/// same flow is theta kappa (t - P_B t) at t = s + c theta (s - P_B s), kappa = 1/(1 + c theta), for any c >=
/// 0: that moves t along the normal only. Eliminating it again leaves the tangent of the flow with respect to
/// s:
///   theta (kappa diag(softening) + x y'/z).
template <size_t n>
struct ProjectionOnYield {
  std::array<Lanes, n> overstress;  ///< t - P_B t = m b/(1 + m b) t [Pa]
  std::array<Lanes, 2> softening;   ///< m b/(1 + kappa m b) [-]
  std::array<Lanes, 2> stretch;     ///< (1 + m b)/(1 + kappa m b) [-]
  std::array<Lanes, n> x;
  std::array<Lanes, n> y;
  Lanes z;
};

/// \tparam B  a number, or one for each of eight stresses
template <class B>
class YieldDomain {
 public:
  YieldDomain(double yieldStress, const Pair& a, const std::array<B, 2>& b)
      : scale_(1 / yieldStress), a_(a), b_(b) {}

  /// Of one stress or of eight. A stress on the yield surface, up to rounding, counts as beyond it: with the
  /// elastic tangent there Newton cycles.
  template <class Scalar, size_t n>
  [[nodiscard]] auto yields(const std::array<Scalar, n>& s) const {
    constexpr double onSurface = 1 - 1e-10;
    const auto [p, q] = square(s);
    return p + q >= onSurface;
  }

  /// Lanes outside `flowing` get the projection with m = 0.
  template <size_t n>
  [[nodiscard]] ProjectionOnYield<n> project(const std::array<Lanes, n>& t, const Lanes& kappa,
                                             const LaneMask& flowing) const {
    const Lanes m = multiplier(t, flowing);
    ProjectionOnYield<n> result;
    result.z = 0;
    for (size_t i = 0; i < n; ++i) {
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
  /// The parts of the first direction and of the others in a . s^2 / sigma_Y^2.
  template <class Scalar, size_t n>
  [[nodiscard]] std::array<Scalar, 2> square(const std::array<Scalar, n>& s) const {
    const Scalar p = s[0] * scale_;
    Scalar others = (s[1] * scale_) * (s[1] * scale_);
    for (size_t k = 2; k < n; ++k) others += (s[k] * scale_) * (s[k] * scale_);
    return {a_[0] * p * p, a_[1] * others};
  }

  /// psi(m) = (sum a s^2/(sigma_Y^2 (1 + m b)^2))^(-1/2) is concave and rises to 1 at the root: Newton from
  /// the left climbs monotonically and ends when it no longer climbs. On a common denominator, with d = 1 + m
  /// b, psi is
  ///   d_p d_q / sqrt(p d_q^2 + q d_p^2).
  /// A lane that has arrived stays, so no lane depends on its neighbours.
  template <size_t n>
  [[nodiscard]] Lanes multiplier(const std::array<Lanes, n>& t, LaneMask climbing) const {
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
      m = select(climbing, m + step, m);
      climbing = climbing && step > last * m;
      if (none_of(climbing)) break;
    }
    return m;
  }

  double scale_;
  Pair a_;
  std::array<B, 2> b_;
};

}  // namespace mortier
