#include "material/perzyna.h"

#include <cmath>

#include "material/deviatoric.h"

namespace mortier {

template <size_t n>
PerzynaLaw<n>::PerzynaLaw(const Pair& e, const Pair& a, const Pair& w, const Viscoplasticity& law)
    : ElasticLaw<n>(e),
      a_(a),
      w_(w),
      law_(law),
      symmetric_(w[0] == w[1]),
      domain_(law.yieldStress, a, {a[0] / w[0], a[1] / w[1]}) {}

// With v = strain - E^-1 (s - s0), theta = weight/(2 lambda) and t = s + c v, the law v = theta (s - P_B s)
// reads
//   v = theta kappa (t - P_B t),  kappa = 1/(1 + c theta),
// and its linearisation in s and strain is (yield_domain.h)
//   H ds = B d + r,  H = E^-1 + theta kappa diag(softening) + (theta/z) x y',
// a rank-one change of a diagonal matrix. c = 0 judges yielding by s alone; `anticipate` by a stress that v
// moves by up to E v while v is small, never far beyond the yield surface when it is large.
template <size_t n>
PointAnswer<n> PerzynaLaw<n>::linearise(const PointStep<n>& point) const {
  constexpr double reach = 100;  // in yield stresses, for v >> sigma_Y/E
  const double theta = this->theta(point.weight);
  const Stress v = this->flowStrain(point);
  Lanes c = 0;
  Stress t = point.stress;
  if (point.anticipate) {
    c = 1 / (1 / e_[1] + sqrt(dot(v, v)) / (reach * law_.yieldStress));
    for (size_t k = 0; k < n; ++k) t[k] += c * v[k];
  }
  Stress h;
  for (size_t k = 0; k < n; ++k) h[k] = e_[k];
  Stress r = v;
  Stress hx{};
  Stress hy{};
  Lanes rankOne = 0;
  const LaneMask flowing = domain_.yields(t);
  PointAnswer<n> answer;
  answer.flows = any_of(flowing);
  if (answer.flows) {
    const Lanes kappa = point.anticipate ? 1 / (1 + c * theta) : Lanes(1);
    const ProjectionOnYield<n> P = domain_.project(t, kappa, flowing);
    for (size_t k = 0; k < n; ++k) r[k] = select(flowing, v[k] - theta * kappa * P.overstress[k], v[k]);
    if (point.anticipate) {
      const Lanes along = c * theta * dot(P.y, r) / P.z;
      for (size_t k = 0; k < n; ++k)
        r[k] = select(flowing, P.stretch[k == 0 ? 0 : 1] * r[k] + along * P.x[k], v[k]);
    }
    const Lanes hp = 1 / (1 / e_[0] + theta * kappa * P.softening[0]);
    const Lanes hq = 1 / (1 / e_[1] + theta * kappa * P.softening[1]);
    for (size_t k = 0; k < n; ++k) {
      h[k] = select(flowing, k == 0 ? hp : hq, h[k]);
      hx[k] = h[k] * P.x[k];
      hy[k] = h[k] * P.y[k];
    }
    rankOne = select(flowing, theta / (P.z + theta * dot(P.y, hx)), 0);
  }
  const Lanes along = rankOne * dot(hy, r);
  answer.predictor = point.stress;
  for (size_t k = 0; k < n; ++k) {
    answer.change[k] = h[k] * r[k] - along * hx[k];
    answer.predictor[k] += answer.change[k];
  }
  answer.moduli = diagonalMinusRankOne(h, rankOne, hx, hy);
  return answer;
}

// t solves A (t - s) = v - theta (t - P_B t), A = D^-1 + E^-1, v as above. With x = s + v/A and
// kappa = 1/(1 + theta/A) it is t = x - (theta kappa/A) (x - P x), P the projection with the weights w kappa.
template <size_t n>
PointAnswer<n> PerzynaLaw<n>::regularise(const PointStep<n>& point, const Lanes& penalty) const {
  const double theta = this->theta(point.weight);
  const Stress v = this->flowStrain(point);
  PointAnswer<n> answer;
  Stress A;
  Stress kappa;
  Stress x = point.stress;
  Stress D;
  for (size_t k = 0; k < n; ++k) {
    A[k] = 2 / e_[k] + penalty * theta;
    kappa[k] = A[k] / (A[k] + theta);
    answer.change[k] = v[k] / A[k];
    x[k] += answer.change[k];
    D[k] = 1 / (1 / e_[k] + penalty * theta);
  }
  const LaneMask flowing = domain_.yields(x);
  if (any_of(flowing)) {
    const YieldDomain<Lanes> domain(law_.yieldStress, a_,
                                    {a_[0] / (w_[0] * kappa[0]), a_[1] / (w_[1] * kappa[1])});
    const Stress overstress = domain.project(x, 1, flowing).overstress;
    for (size_t k = 0; k < n; ++k)
      answer.change[k] = select(flowing, (v[k] - theta * kappa[k] * overstress[k]) / A[k], answer.change[k]);
  }
  answer.moduli = diagonalMinusRankOne<n>(D, 0, {}, {});
  return answer;
}

// The flow stiffens by 1 along the normal of the yield surface and by `softening` at least along it.
template <size_t n>
Lanes PerzynaLaw<n>::penalty(const Stress& stress) const {
  const LaneMask flowing = domain_.yields(stress);
  const ProjectionOnYield<n> P = domain_.project(stress, 1, flowing);
  return select(flowing, sqrt(min(P.softening[0], P.softening[1])), 0);
}

template <size_t n>
typename PerzynaLaw<n>::Stress PerzynaLaw<n>::rate(const Stress& stress, const Stress& /*total*/) const {
  const LaneMask flowing = domain_.yields(stress);
  Stress rate{};
  if (none_of(flowing)) return rate;
  const ProjectionOnYield<n> P = domain_.project(stress, 1, flowing);
  for (size_t k = 0; k < n; ++k) rate[k] = select(flowing, P.overstress[k] / (2 * law_.viscosity), 0);
  return rate;
}

template <size_t n>
ConeLaw PerzynaLaw<n>::cone(double weight) const requires(n == 3) {
  const auto three = [](const Pair& x) { return Eigen::Array3d(x[0], x[1], x[1]); };
  return {three({e_[0], e_[1]}), three(a_), three(a_) / three(w_), law_.yieldStress, theta(weight)};
}

template class PerzynaLaw<3>;
template class PerzynaLaw<5>;

void requireValid(const Viscoplasticity& viscoplasticity) {
  requireParameter(viscoplasticity.viscosity > 0, "viscosity", viscoplasticity.viscosity,
                   "viscosity > 0 [Pa s]");
  requireParameter(viscoplasticity.yieldStress > 0, "yield_stress", viscoplasticity.yieldStress,
                   "yield_stress > 0 [Pa]");
}

LawDescription describe(const Elasticity& elasticity, const Viscoplasticity& viscoplasticity) {
  LawDescription description = describe("Perzyna", elasticity);
  description.parameters.push_back({"viscosity", viscoplasticity.viscosity, "Pa s"});
  description.parameters.push_back({"yield_stress", viscoplasticity.yieldStress, "Pa"});
  description.projects = true;
  return description;
}

std::shared_ptr<const Material> perzynaMaterial(const Elasticity& elasticity,
                                                const Viscoplasticity& viscoplasticity, Plane plane) {
  requireValid(elasticity);
  requireValid(viscoplasticity);
  LawDescription description = describe(elasticity, viscoplasticity);
  Pair w{1, 1};
  if (plane == Plane::stress) {
    const Eigen::Array3d e = elasticity.moduli();
    if (viscoplasticity.projection == Projection::elasticity) w[0] = e[0] / e[1];
    if (viscoplasticity.projection == Projection::compliance) w[0] = e[1] / e[0];
    description.variant = projectionNames[static_cast<int>(viscoplasticity.projection)];
  }
  return isotropicMaterial(elasticity, plane, description, [&]<size_t n>(const Pair& e, const Pair& a) {
    return PerzynaLaw<n>(e, a, w, viscoplasticity);
  });
}

}  // namespace mortier
