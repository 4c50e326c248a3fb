#include "material/norton.h"

#include <cmath>
#include <limits>

namespace mortier {

NortonLaw::NortonLaw(const Pair& e, const Pair& a, const NortonCreep& creep)
    : e_{e[0], e[1], e[1]}, a_{a[0], a[1], a[1]}, creep_(creep) {}

Lanes NortonLaw::square(const LaneVector& stress) const {
  Lanes sum = std::numeric_limits<double>::min();
  for (int k = 0; k < 3; ++k) {
    const Lanes u = stress[k] * (1 / creep_.referenceStress);
    sum += a_[k] * u * u;
  }
  return sum;
}

// Powers overflow before their logarithms do.
Lanes NortonLaw::logarithm(double weight, const Lanes& square) const {
  const double atReference =
      std::log(weight) + std::log(creep_.referenceRate) - std::log(creep_.referenceStress);
  return atReference + (creep_.exponent - 1) / 2 * log(square);
}

LaneVector NortonLaw::rest(const PointStep<3>& point) const {
  LaneVector v = point.strain;
  for (int k = 0; k < 3; ++k) v[k] -= (point.stress[k] - point.stress0[k]) / e_[k];
  return v;
}

// With v = strain - E^-1 (s - s0) the law is v = weight G(s). It is linearised at a stress x = l s: as
// G(l s) = l^n G(s), with theta = weight (rate0/sigma0) (l vM/sigma0)^(n-1)
//   weight (G(x) + G'(x) (s - x)) = theta (n - (n-1) l) a s,
//   H = E^-1 + theta (diag(a) + (n-1) w w'),   w = a s/vM.
// On the law l = 1, so that convergence is quadratic; elsewhere l is free. Let kappa = weight |G(s)|/vM and
// mu = v . s/vM^2, equal on the law, and m = E mu. A stress far above the law (kappa > mu) may be one that
// loads ask for, before it has crept: then l = 1 is right, and m is next to 0. Or it is elastic, for a strain
// that is given: then v is right, and so is the stress whose flow it is, l^n = mu/kappa, while l = 1 would
// come down by 1/n in each iteration. In between is the stress x for which c weight G(x) is as much as
// s + c v, where c goes from 0 to E as the flow outgrows the elastic strain. If v is against s, so much of
// the stress is to go back. A stress below the law, from which l = 1 would jump up to elasticity, is
// linearised halfway to the stress whose flow is v. The tangents of all these stresses pass s on one side: no
// change of stress is 0 off the law.
PointAnswer<3> NortonLaw::linearise(const PointStep<3>& point) const {
  constexpr double farthest = 30;  // of log l
  constexpr double stiffest = 70;  // of log(theta e), far beyond what doubles resolve
  const double n = creep_.exponent;
  const LaneVector v = rest(point);
  const Lanes g2 = square(point.stress);
  const Lanes vM = creep_.referenceStress * sqrt(g2);
  const Lanes kappa = logarithm(point.weight, g2) + std::log(e_[1]);  // log(E kappa)
  const Lanes m = e_[1] * dot(v, point.stress) / vM / vM;
  const Lanes along = max(m, Lanes(std::numeric_limits<double>::min()));
  const Lanes M = along / (1 + 1 / along);  // c mu
  const Lanes down = min(Lanes(0), (log(1 + M) - log(M) + log(along) - kappa) * (1 / n));
  const Lanes up = min(Lanes(farthest), (log(along) - kappa) * (0.5 / n));
  const Lanes back = log(max(Lanes(0.5), 1 + min(m, Lanes(0))));
  Lanes l = select(m > 0, select(kappa > log(along), down, up), back);
  if (n > 1) l = min(l, (stiffest - kappa) * (1 / (n - 1)));
  const Lanes theta = exp(kappa + (n - 1) * l) / e_[1];
  const Lanes part = theta * (n - (n - 1) * exp(l));

  LaneVector h;
  LaneVector hw;
  LaneVector r;
  Lanes wHw = 0;
  for (int k = 0; k < 3; ++k) {
    const Lanes w = a_[k] * point.stress[k] / vM;
    h[k] = 1 / (1 / e_[k] + theta * a_[k]);
    hw[k] = h[k] * w;
    wHw += w * hw[k];
    r[k] = v[k] - part * a_[k] * point.stress[k];
  }
  const Lanes c = (n - 1) * theta / (1 + (n - 1) * theta * wHw);
  const Lanes alongW = c * dot(hw, r);
  PointAnswer<3> answer{point.stress, {}, diagonalMinusRankOne(h, c, hw, hw), true};
  for (int k = 0; k < 3; ++k) {
    answer.change[k] = h[k] * r[k] - alongW * hw[k];
    answer.predictor[k] += answer.change[k];
  }
  return answer;
}

// D = E: t solves 2 E^-1 (t - s) + theta a t = v, theta = weight (rate0/sigma0) (vM(t)/sigma0)^(n-1), so
// t = x/(1 + theta b) with x = s + E v/2 and b = E a/2. In y = log theta it is y = logarithm(t(y)), whose
// right side falls by no more than (n-1) y: Newton's method from the right, where t < x and t < x/(theta b).
PointAnswer<3> NortonLaw::regularise(const PointStep<3>& point, const Lanes& /*penalty*/) const {
  constexpr int most = 100;
  constexpr double last = 1e-14;
  const double n = creep_.exponent;
  const LaneVector v = rest(point);
  LaneVector x = point.stress;
  LaneVector xOverB;
  for (int k = 0; k < 3; ++k) {
    x[k] += 0.5 * e_[k] * v[k];
    xOverB[k] = x[k] / (0.5 * e_[k] * a_[k]);
  }
  LaneVector t = x;
  Lanes y = min(logarithm(point.weight, square(x)), logarithm(point.weight, square(xOverB)) / n);
  LaneMask moving = y > -std::numeric_limits<double>::infinity();
  for (int iteration = 0; iteration < most && any_of(moving); ++iteration) {
    const Lanes theta = exp(y);
    Lanes falls = 0;
    for (int k = 0; k < 3; ++k) {
      const Lanes tb = 0.5 * theta * e_[k] * a_[k];
      t[k] = x[k] / (1 + tb);
      const Lanes u = t[k] * (1 / creep_.referenceStress);
      falls += a_[k] * u * u * (tb / (1 + tb));
    }
    const Lanes g2 = square(t);
    const Lanes step = (y - logarithm(point.weight, g2)) / (1 + (n - 1) * falls / g2);
    y = select(moving, y - step, y);
    moving = moving && abs(step) > last * max(Lanes(1), abs(y));
  }
  const Lanes theta = exp(y);
  PointAnswer<3> answer{point.stress, {}, diagonalMinusRankOne<3>({e_[0], e_[1], e_[2]}, 0, {}, {}), true};
  for (int k = 0; k < 3; ++k) {
    const Lanes tb = 0.5 * theta * e_[k] * a_[k];
    answer.change[k] = (0.5 * e_[k] * v[k] - tb * point.stress[k]) / (1 + tb);
  }
  return answer;
}

LaneVector NortonLaw::rate(const LaneVector& stress, const LaneVector& /*total*/) const {
  const Lanes theta = exp(logarithm(1, square(stress)));
  LaneVector rate = stress;
  for (int k = 0; k < 3; ++k) rate[k] *= theta * a_[k];
  return rate;
}

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
  const Eigen::Array3d e = elasticity.moduli();
  if (plane == Plane::stress)
    return pointMaterial(NortonLaw({e[0], e[1]}, {0.5, 1.5}, creep), describe(elasticity, creep));
  return pointMaterial(InPlaneStrain(NortonLaw({e[1], e[1]}, {1.5, 1.5}, creep), elasticity),
                       describe(elasticity, creep));
}

}  // namespace mortier
