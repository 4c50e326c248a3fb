#include "material/yield_domain.h"

#include <cmath>

namespace mortier {

YieldDomain yieldDomain(double yieldStress, const Eigen::Array3d& norm) {
  return {yieldStress, Eigen::Array3d(0.5, 1.5, 1.5), norm};
}

// psi(m) = (sum a s^2/(sigma_Y^2 (1 + m b)^2))^(-1/2) is concave and rises to 1 at the root: Newton from the
// left climbs monotonically and ends when it no longer climbs.
double YieldDomain::multiplier(const Eigen::Array3d& s) const {
  const Eigen::Array3d square = a_ * (s / yieldStress_).square();
  constexpr double last = 1e-9;
  double m = 0;
  for (int iteration = 0; iteration < 60; ++iteration) {
    const Eigen::Array3d c = 1 / (1 + m * b_);
    const Eigen::Array3d phi = square * c * c;
    const double value = phi.sum();
    const double step = value * (std::sqrt(value) - 1) / (phi * c * b_).sum();
    if (!(step > 0)) break;
    m += step;
    if (step <= last * m) break;
  }
  return m;
}

// From a . P^2 = sigma_Y^2, with c = 1/(1 + m b):
//   dP = c dt - t b c^2 dm,  dm = (a t c^2 . dt)/(sum of a b t^2 c^3),
// so 1 - P_B' = diag(m b c) + x y'/z; kappa < 1 then divides each by (1 + kappa m b)/(1 + m b).
ProjectionOnYield YieldDomain::project(const Eigen::Array3d& t, double kappa) const {
  const double m = multiplier(t);
  const Eigen::Array3d c = 1 / (1 + m * b_);
  const Eigen::Array3d k = 1 / (1 + kappa * m * b_);
  ProjectionOnYield result;
  result.overstress = m * b_ * c * t;
  result.softening = m * b_ * k;
  result.stretch = (1 + m * b_) * k;
  result.x = t * b_ * c * k;
  result.y = a_ * t * c * k;
  result.z = (a_ * b_ * (t * c).square() * k).sum();
  return result;
}

}  // namespace mortier
