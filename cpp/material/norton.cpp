#include "material/norton.h"

#include <cmath>
#include <limits>

namespace mortier {

template <size_t n>
NortonLaw<n>::NortonLaw(const Pair& e, const Pair& a, const NortonCreep& creep)
    : ElasticLaw<n>(e), a_(onDirections<n>(a)), creep_(creep) {}

template <size_t n>
Lanes NortonLaw<n>::square(const Stress& stress) const {
  Lanes sum = std::numeric_limits<double>::min();
  for (size_t k = 0; k < n; ++k) {
    const Lanes u = stress[k] * (1 / creep_.referenceStress);
    sum += a_[k] * u * u;
  }
  return sum;
}

// Powers overflow before their logarithms do.
template <size_t n>
Lanes NortonLaw<n>::logarithm(double weight, const Lanes& square) const {
  const double atReference =
      std::log(weight) + std::log(creep_.referenceRate) - std::log(creep_.referenceStress);
  return atReference + (creep_.exponent - 1) / 2 * log(square);
}

// With v = strain - E^-1 (s - s0) the law is v = weight G(s). It is linearised at a stress x = l s: as
// G(l s) = l^n G(s), with theta = weight (rate0/sigma0) (l vM/sigma0)^(n-1)
//   weight (G(x) + G'(x) (s - x)) = theta (n - (n-1) l) a s,
//   H = E^-1 + theta (diag(a) + (n-1) w w'),   w = a s/vM.
// On the law l = 1, so that convergence is quadratic; elsewhere l is free. Let kappa = weight |G(s)|/vM and
// mu = v . s/vM^2, equal on the law, and m = E mu. A stress far above the law (kappa > mu) may be one that
// loads require, before it has crept: then l = 1 is right, and m is next to 0. Or it is elastic, for a strain
// that is given: then v is right, and so is the stress whose flow it is, l^n = mu/kappa, while l = 1 would
// come down by 1/n in each iteration. In between is the stress x for which c weight G(x) is as much as
// s + c v, where c goes from 0 to E as the flow outgrows the elastic strain. If v is against s, so much of
// the stress is to go back. A stress below the law, from which l = 1 would jump up to elasticity, is
// linearised halfway to the stress whose flow is v. The tangents of all these stresses pass s on one side: no
// change of stress is 0 off the law.
template <size_t n>
PointAnswer<n> NortonLaw<n>::linearise(const PointStep<n>& point) const {
  constexpr double farthest = 30;  // of log l
  constexpr double stiffest = 70;  // of log(theta e), far beyond what doubles resolve
  const double power = creep_.exponent;
  const Stress v = this->flowStrain(point);
  const Lanes g2 = square(point.stress);
  const Lanes vM = creep_.referenceStress * sqrt(g2);
  const Lanes kappa = logarithm(point.weight, g2) + std::log(e_[1]);  // log(E kappa)
  const Lanes m = e_[1] * dot(v, point.stress) / vM / vM;
  const Lanes along = max(m, Lanes(std::numeric_limits<double>::min()));
  const Lanes M = along / (1 + 1 / along);  // c mu
  const Lanes down = min(Lanes(0), (log(1 + M) - log(M) + log(along) - kappa) * (1 / power));
  const Lanes up = min(Lanes(farthest), (log(along) - kappa) * (0.5 / power));
  const Lanes back = log(max(Lanes(0.5), 1 + min(m, Lanes(0))));
  Lanes l = select(m > 0, select(kappa > log(along), down, up), back);
  if (power > 1) l = min(l, (stiffest - kappa) * (1 / (power - 1)));
  const Lanes theta = exp(kappa + (power - 1) * l) / e_[1];
  const Lanes part = theta * (power - (power - 1) * exp(l));

  Stress h;
  Stress hw;
  Stress r;
  Lanes wHw = 0;
  for (size_t k = 0; k < n; ++k) {
    const Lanes w = a_[k] * point.stress[k] / vM;
    h[k] = 1 / (1 / e_[k] + theta * a_[k]);
    hw[k] = h[k] * w;
    wHw += w * hw[k];
    r[k] = v[k] - part * a_[k] * point.stress[k];
  }
  const Lanes c = (power - 1) * theta / (1 + (power - 1) * theta * wHw);
  const Lanes alongW = c * dot(hw, r);
  PointAnswer<n> answer{point.stress, {}, diagonalMinusRankOne(h, c, hw, hw), true};
  for (size_t k = 0; k < n; ++k) {
    answer.change[k] = h[k] * r[k] - alongW * hw[k];
    answer.predictor[k] += answer.change[k];
  }
  return answer;
}

// D = E: t solves 2 E^-1 (t - s) + theta a t = v, theta = weight (rate0/sigma0) (vM(t)/sigma0)^(n-1), so
// t = x/(1 + theta b) with x = s + E v/2 and b = E a/2. In y = log theta it is y = logarithm(t(y)), whose
// right side falls by no more than (n-1) y: Newton's method from the right, where t < x and t < x/(theta b).
template <size_t n>
PointAnswer<n> NortonLaw<n>::regularise(const PointStep<n>& point, const Lanes& /*penalty*/) const {
  constexpr int most = 100;
  constexpr double last = 1e-14;
  const double power = creep_.exponent;
  const Stress v = this->flowStrain(point);
  Stress x = point.stress;
  Stress xOverB;
  for (size_t k = 0; k < n; ++k) {
    x[k] += 0.5 * e_[k] * v[k];
    xOverB[k] = x[k] / (0.5 * e_[k] * a_[k]);
  }
  Stress t = x;
  Lanes y = min(logarithm(point.weight, square(x)), logarithm(point.weight, square(xOverB)) / power);
  LaneMask moving = y > -std::numeric_limits<double>::infinity();
  for (int iteration = 0; iteration < most && any_of(moving); ++iteration) {
    const Lanes theta = exp(y);
    Lanes falls = 0;
    for (size_t k = 0; k < n; ++k) {
      const Lanes tb = 0.5 * theta * e_[k] * a_[k];
      t[k] = x[k] / (1 + tb);
      const Lanes u = t[k] * (1 / creep_.referenceStress);
      falls += a_[k] * u * u * (tb / (1 + tb));
    }
    const Lanes g2 = square(t);
    const Lanes step = (y - logarithm(point.weight, g2)) / (1 + (power - 1) * falls / g2);
    y = select(moving, y - step, y);
    moving = moving && abs(step) > last * max(Lanes(1), abs(y));
  }
  const Lanes theta = exp(y);
  PointAnswer<n> answer{point.stress, {}, this->moduli(), true};
  for (size_t k = 0; k < n; ++k) {
    const Lanes tb = 0.5 * theta * e_[k] * a_[k];
    answer.change[k] = (0.5 * e_[k] * v[k] - tb * point.stress[k]) / (1 + tb);
  }
  return answer;
}

template <size_t n>
std::array<Lanes, n> NortonLaw<n>::rate(const Stress& stress, const Stress& /*total*/) const {
  const Lanes theta = exp(logarithm(1, square(stress)));
  Stress rate = stress;
  for (size_t k = 0; k < n; ++k) rate[k] *= theta * a_[k];
  return rate;
}

template class NortonLaw<3>;
template class NortonLaw<5>;

void requireValid(const NortonCreep& creep) {
  requireParameter(creep.referenceStress > 0, "reference_stress", creep.referenceStress,
                   "reference_stress > 0 [Pa]");
  requireParameter(creep.referenceRate > 0, "reference_rate", creep.referenceRate,
                   "reference_rate > 0 [1/s]");
  requireParameter(creep.exponent >= 1, "exponent", creep.exponent, "exponent >= 1");
}

LawDescription describe(const Elasticity& elasticity, const NortonCreep& creep) {
  LawDescription description = describe("Norton", elasticity);
  description.parameters.push_back({"reference_stress", creep.referenceStress, "Pa"});
  description.parameters.push_back({"reference_rate", creep.referenceRate, "1/s"});
  description.parameters.push_back({"exponent", creep.exponent, ""});
  return description;
}

std::shared_ptr<const Material> nortonMaterial(const Elasticity& elasticity, const NortonCreep& creep,
                                               Plane plane) {
  requireValid(elasticity);
  requireValid(creep);
  return isotropicMaterial(elasticity, plane, describe(elasticity, creep),
                           [&]<size_t n>(const Pair& e, const Pair& a) { return NortonLaw<n>(e, a, creep); });
}

}  // namespace mortier
