#include "material/overstress.h"

#include <cmath>
#include <limits>

namespace mortier {
namespace {

constexpr double tiny = std::numeric_limits<double>::min();

}  // namespace

void Overstress::setViscosity(double viscosity) {
  exponent = 1;
  referenceRate = 1;
  referenceStress = 3 * viscosity;
}

// A stress on the yield surface counts as beyond it: Newton's method would turn in circles. In plasticity it
// is there but for the residual.
template <size_t n>
OverstressFlow<n>::OverstressFlow(const Pair& e, const Pair& a, const Overstress& law)
    : e_(onDirections<n>(e)),
      a_(onDirections<n>(a)),
      least_(std::min(e[0] * a[0], e[1] * a[1])),
      onSurface_(law.viscous() ? 1 - 1e-10 : 1 - 1e-7),
      law_(law) {}

template <size_t n>
Lanes OverstressFlow<n>::mises(const Stress& z) const {
  Lanes square = a_[0] * z[0] * z[0];
  for (size_t k = 1; k < n; ++k) square += a_[k] * z[k] * z[k];
  return sqrt(square);
}

// With tau = overstress/sigma0, C = c + H + K, B = C weight rate0/sigma0 and X = vM(x) - sigma_Y + rho it is
//   tau + B tau^m = X/sigma0,
// convex in log tau: Newton's method from the right, where one of both is X/sigma0, climbs down at once. What
// it finds shares X among the overstress and C dp.
template <size_t n>
typename OverstressFlow<n>::Return OverstressFlow<n>::radialReturn(const Stress& x, const Lanes& c,
                                                                   const Lanes& rho, double weight) const {
  constexpr int most = 60;
  constexpr double last = 1e-15;
  const double m = law_.exponent;
  const Lanes size = mises(x);
  const Lanes yields = law_.yieldStress - rho;
  Return point;
  point.flowing = size >= onSurface_ * yields && LaneMask(weight > 0);
  const Lanes beyond = select(point.flowing, max(Lanes(0), size - yields), 0);
  const Lanes C = c + law_.kinematicHardening + law_.isotropicHardening;
  Lanes over = 0;
  if (!law_.viscous()) {
    point.dp = beyond / C;
    point.slope = 0;  // infinite
  } else if (m == 1) {
    const double fluidity = weight * law_.referenceRate / law_.referenceStress;
    over = beyond / (1 + C * fluidity);
    point.dp = over * fluidity;
    point.slope = fluidity;
  } else {
    const Lanes X = max(Lanes(tiny), beyond * (1 / law_.referenceStress));
    const Lanes logB = log(C) + std::log(weight * law_.referenceRate / law_.referenceStress);
    Lanes y = min(log(X), (log(X) - logB) / m);
    LaneMask moving = point.flowing;
    Lanes tau = exp(y);
    Lanes flow = exp(logB + m * y);
    for (int k = 0; k < most && any_of(moving); ++k) {
      const Lanes step = (tau + flow - X) / (tau + m * flow);
      y = select(moving, y - step, y);
      moving = moving && abs(step) > last * max(Lanes(1), abs(y));
      tau = exp(y);
      flow = exp(logB + m * y);
    }
    const Lanes all = max(tau + flow, Lanes(tiny));
    over = beyond * (tau / all);
    point.dp = beyond * (flow / all) / C;
    point.slope = m * (flow / max(tau, Lanes(tiny))) / C;
  }
  point.slope = select(point.flowing, point.slope, 0);
  point.mises = yields + law_.isotropicHardening * point.dp + over;
  for (size_t k = 0; k < n; ++k) point.u[k] = select(point.flowing, a_[k] * x[k] / max(size, Lanes(tiny)), 0);
  return point;
}

template <size_t n>
std::array<Lanes, n> OverstressFlow<n>::backStress(const Stress& viscoplasticStrain) const {
  Stress back;
  for (size_t k = 0; k < n; ++k) back[k] = law_.kinematicHardening / a_[k] * viscoplasticStrain[k];
  return back;
}

template <size_t n>
std::array<Lanes, n> OverstressFlow<n>::backStress(const Point& point) const {
  if (!(law_.kinematicHardening > 0)) return {};
  Stress flowed;
  for (size_t k = 0; k < n; ++k) flowed[k] = point.total[k] - point.strain[k] - point.stress0[k] / e_[k];
  return backStress(flowed);
}

// With v = strain - E^-1 (s - s0) the law is v = dp u. It is linearised at the point (s~, v~) of it for which
//   s~ + c a^-1 v~ = s + c a^-1 v :
// with c = 0 at the stress, with c about E where the strain leads (return mapping), which large strains would
// round off. In the metric of a, the flow has the compliance theta = dp/vM across u and g along it; beside
// the back stress 1/(1/theta + H) and 1/(1/g + H), with isotropic hardening 1/(1/g + H + K), together W. From
//   v + B d - E^-1 ds = v~ + W (s + ds - s~)
// with D = (E^-1 + W)^-1 it follows that ds = D B d + c a^-1 (v - v~) + D (1 - c (E a)^-1) (v - v~), in which
// nothing is infinite where g is.
template <size_t n>
typename OverstressFlow<n>::Answer OverstressFlow<n>::linearise(const Point& point) const {
  constexpr double reach = 100;  // in yield stresses, for v >> sigma_Y/E
  constexpr double trace = 1e-10;
  const double H = law_.kinematicHardening;
  const double K = law_.isotropicHardening;
  Stress v = point.strain;
  Lanes length = 0;
  for (size_t k = 0; k < n; ++k) {
    v[k] -= (point.stress[k] - point.stress0[k]) / e_[k];
    length += v[k] * v[k] / a_[k];
  }
  const Lanes c = 1 / (1 / least_ + sqrt(length) / (reach * law_.yieldStress));
  Stress x = point.stress;
  const Stress back = backStress(point);
  for (size_t k = 0; k < n; ++k) x[k] += c / a_[k] * v[k] - back[k];
  const Lanes rho = point.rho0 + K * point.strainOfRho;  // without flow
  const Return flow = radialReturn(x, c, rho, point.weight);

  const Lanes thetaOfFlow = flow.dp / flow.mises;
  const Lanes theta = thetaOfFlow / (1 + H * thetaOfFlow);
  // g as along/resistance: both are finite. A body that flows as it likes would have a singular tangent: the
  // tangent of plasticity keeps a trace of elasticity, the residual does not.
  const double tangent = std::max(H + K, trace * least_);
  const Lanes along = law_.viscous() ? flow.slope : select(flow.flowing, Lanes(1), Lanes(0));
  const Lanes resistance =
      law_.viscous() ? 1 + (H + K) * flow.slope : select(flow.flowing, Lanes(tangent), Lanes(1));
  Stress h;
  Stress hu;
  Stress y;
  Lanes U = 0;
  Lanes hy = 0;
  Answer answer;
  answer.flows = any_of(flow.flowing);
  for (size_t k = 0; k < n; ++k) {
    const Lanes off = v[k] - flow.dp * flow.u[k];
    h[k] = 1 / (1 / e_[k] + theta * a_[k]);
    hu[k] = h[k] * flow.u[k];
    y[k] = (1 - c / (e_[k] * a_[k])) * off;
    U += flow.u[k] * hu[k];
    hy += hu[k] * y[k];
    answer.change[k] = c / a_[k] * off;
  }
  const Lanes rank = along - theta * resistance;
  const Lanes F = rank / (resistance + rank * U);
  Lanes further = 0;  // u . D y
  for (size_t k = 0; k < n; ++k) {
    const Lanes Dy = h[k] * y[k] - F * hy * hu[k];
    further += flow.u[k] * Dy;
    answer.change[k] += Dy;
  }
  answer.moduli = diagonalMinusRankOne(h, F, hu, hu);
  if (K > 0) {
    const Lanes g = along / resistance;
    answer.rho = rho - K * (flow.dp + g * further);
    const Lanes part = 1 - F * U;  // D u = part hu
    for (size_t k = 0; k < n; ++k) answer.mixed[k] = -K * g * part * hu[k];
    answer.ofRho = K - K * K * g * (1 - g * part * U);
  }
  return answer;
}

template <size_t n>
typename OverstressFlow<n>::Answer OverstressFlow<n>::regularise(const Point& point) const {
  const double c = least_ / 2;
  Stress x = point.stress;
  Stress v = point.strain;
  const Stress back = backStress(point);
  for (size_t k = 0; k < n; ++k) {
    v[k] -= (point.stress[k] - point.stress0[k]) / e_[k];
    x[k] += c / a_[k] * v[k] - back[k];
  }
  const Lanes rho = point.rho0 + law_.isotropicHardening * point.strainOfRho;
  const Return flow = radialReturn(x, c, rho, point.weight);
  Answer answer;
  Stress D;
  for (size_t k = 0; k < n; ++k) {
    answer.change[k] = c / a_[k] * (v[k] - flow.dp * flow.u[k]);
    D[k] = 1 / (a_[k] / c - 1 / e_[k]);
  }
  answer.flows = true;
  answer.moduli = diagonalMinusRankOne<n>(D, 0, {}, {});
  answer.rho = rho - law_.isotropicHardening * flow.dp;
  answer.ofRho = law_.isotropicHardening;
  return answer;
}

template <size_t n>
std::pair<std::array<Lanes, n>, Lanes> OverstressFlow<n>::rate(const Stress& stress, const Stress& total,
                                                               const Lanes& rho) const {
  Stress z = stress;
  if (law_.kinematicHardening > 0)
    for (size_t k = 0; k < n; ++k) z[k] -= law_.kinematicHardening / a_[k] * (total[k] - stress[k] / e_[k]);
  const Lanes size = mises(z);
  const Lanes over = max(Lanes(0), size - law_.yieldStress + rho);
  if (!law_.viscous()) return {{}, 0};
  const Lanes tau = over * (1 / law_.referenceStress);
  const Lanes power = law_.exponent == 1 ? tau : select(tau > 0, exp(law_.exponent * log(tau)), 0);
  const Lanes p = law_.referenceRate * power;
  for (size_t k = 0; k < n; ++k) z[k] = p * a_[k] * z[k] / max(size, Lanes(tiny));
  return {z, p};
}

template <size_t n>
bool OverstressFlow<n>::flows(const std::array<double, n>& stress, const std::array<double, n>& total,
                              double rho) const {
  double square = 0;
  for (size_t k = 0; k < n; ++k) {
    const double z = stress[k] - law_.kinematicHardening / a_[k] * (total[k] - stress[k] / e_[k]);
    square += a_[k] * z * z;
  }
  return std::sqrt(square) >= onSurface_ * (law_.yieldStress - rho);
}

// At an overstress of one yield stress.
template <size_t n>
double OverstressFlow<n>::stiffness(double weight) const {
  if (!law_.viscous()) return weight > 0 ? 1 : 0;
  return weight * law_.referenceRate * law_.exponent / law_.referenceStress *
         std::pow(law_.yieldStress / law_.referenceStress, law_.exponent - 1) * std::max(e_[0], e_[1]) * 1.5;
}

template class OverstressFlow<3>;
template class OverstressFlow<5>;

void requireValid(const Overstress& law) {
  requireParameter(law.yieldStress > 0, "yield_stress", law.yieldStress, "yield_stress > 0 [Pa]");
  requireParameter(law.referenceStress >= 0, "reference_stress", law.referenceStress,
                   "reference_stress >= 0 [Pa]");
  requireParameter(law.referenceRate > 0, "reference_rate", law.referenceRate, "reference_rate > 0 [1/s]");
  requireParameter(law.exponent >= 1, "exponent", law.exponent, "exponent >= 1");
  requireParameter(law.kinematicHardening >= 0, "kinematic_hardening", law.kinematicHardening,
                   "kinematic_hardening >= 0 [Pa]");
  requireParameter(law.isotropicHardening >= 0, "isotropic_hardening", law.isotropicHardening,
                   "isotropic_hardening >= 0 [Pa]");
}

LawDescription describe(const Elasticity& elasticity, const Overstress& law) {
  LawDescription description = describe(law.viscous() ? "viscoplastic" : "plastic", elasticity);
  const auto add = [&](const char* name, double value, const char* unit) {
    description.parameters.push_back({name, value, unit});
  };
  add("yield_stress", law.yieldStress, "Pa");
  if (law.viscous()) {
    add("reference_stress", law.referenceStress, "Pa");
    add("reference_rate", law.referenceRate, "1/s");
    add("exponent", law.exponent, "");
  }
  if (law.kinematicHardening > 0) add("kinematic_hardening", law.kinematicHardening, "Pa");
  if (law.isotropicHardening > 0) add("isotropic_hardening", law.isotropicHardening, "Pa");
  return description;
}

}  // namespace mortier
