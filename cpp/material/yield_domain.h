// The elastic domain B = { a . s^2 <= sigma_Y^2 }, a = (1/2, 3/2, 3/2) on p, q, r (von Mises, plane stress),
// and the projection on it in a norm with weights w:
//   (P_B s)_i = s_i / (1 + m b_i),  b_i = a_i / w_i,  m >= 0 the root of  a . (P_B s)^2 = sigma_Y^2.
#pragma once

#include "base/types.h"

namespace mortier {

/// The flow theta (t - P_B t) at a stress t on or beyond yield, and how it changes, free of cancellation. The
/// same flow is theta kappa (t - P_B t) at t = s + c theta (s - P_B s), kappa = 1/(1 + c theta), for any c >=
/// 0: that moves t along the normal only. Eliminating it again leaves the tangent of the flow with respect to
/// s:
///   theta (kappa diag(softening) + x y'/z).
struct ProjectionOnYield {
  Eigen::Array3d overstress;  ///< t - P_B t = m b/(1 + m b) t [Pa]
  Eigen::Array3d softening;   ///< m b/(1 + kappa m b) [-]
  Eigen::Array3d stretch;     ///< (1 + m b)/(1 + kappa m b) [-]
  Eigen::Array3d x;
  Eigen::Array3d y;
  double z = 0;
};

class YieldDomain {
 public:
  YieldDomain(double yieldStress, const Eigen::Array3d& a, const Eigen::Array3d& w)
      : yieldStress_(yieldStress), a_(a), b_(a / w) {}

  /// A stress on the yield surface, up to rounding, counts as beyond it: with the elastic tangent there
  /// Newton cycles.
  [[nodiscard]] bool yields(const Eigen::Array3d& s) const {
    constexpr double onSurface = 1 - 1e-10;
    return (a_ * (s / yieldStress_).square()).sum() >= onSurface;
  }

  [[nodiscard]] const Eigen::Array3d& a() const { return a_; }
  [[nodiscard]] const Eigen::Array3d& b() const { return b_; }

  /// \pre yields(t)
  [[nodiscard]] ProjectionOnYield project(const Eigen::Array3d& t, double kappa = 1) const;

 private:
  /// The root m >= 0.
  [[nodiscard]] double multiplier(const Eigen::Array3d& s) const;

  double yieldStress_;
  Eigen::Array3d a_;
  Eigen::Array3d b_;
};

YieldDomain yieldDomain(double yieldStress, const Eigen::Array3d& norm);

}  // namespace mortier
