// The elastic domain B = { a . s^2 <= sigma_Y^2 }, a = (1/2, 3/2, 3/2) on p, q, r (von Mises, plane stress), and the
// projection on it in a norm with weights w:
//   (P_B s)_i = s_i / (1 + m b_i),  b_i = a_i / w_i,  m >= 0 the root of  a . (P_B s)^2 = sigma_Y^2.
#pragma once

#include "base/types.h"

namespace mortier {

/// P_B at a stress on or beyond yield, without cancellation.
struct ProjectionOnYield {
  Eigen::Array3d overstress;  ///< s - P_B s = m b/(1 + m b) s [Pa]
  Eigen::Array3d softening;   ///< m b/(1 + m b) [-]
  Eigen::Array3d x;           ///< 1 - P_B' = diag(softening) + x y'/z
  Eigen::Array3d y;
  double z = 0;
};

class YieldDomain {
 public:
  YieldDomain(double yieldStress, const Eigen::Array3d& a, const Eigen::Array3d& w)
      : yieldStress_(yieldStress), a_(a), b_(a / w) {}

  /// A stress exactly on the yield surface counts as beyond it: with the elastic tangent there Newton cycles.
  [[nodiscard]] bool yields(const Eigen::Array3d& s) const {
    return (a_ * (s / yieldStress_).square()).sum() >= 1;
  }

  /// \pre yields(s)
  [[nodiscard]] ProjectionOnYield project(const Eigen::Array3d& s) const;

 private:
  /// The root m >= 0.
  [[nodiscard]] double multiplier(const Eigen::Array3d& s) const;

  double yieldStress_;
  Eigen::Array3d a_;
  Eigen::Array3d b_;
};

YieldDomain yieldDomain(double yieldStress, const Eigen::Array3d& norm);

}  // namespace mortier
