// What a body adds to the bounds of flow, by integrals over the parts of composite triangles, in which s^ is
// linear: of squares exactly, of D(s^; t) from above (flow_potential.h). To that of a step (energy_bound.h),
// and to that of a run (total_bound.h), where between the ends of a step s^ is linear in time, and
// s~ = E (eps(u^) - eps^_p), whose strain eps^_p flows at the rate G(t) that the law has for u^: that of the
// finite elements where the lift moves nothing.
#pragma once

#include <array>
#include <vector>

#include "bound/loaded_body.h"

namespace mortier {

// How an error grows in a run: with Z >= 0 and a rate e >= 0 such that
//
//   Z' + lambda e  <=  delta + |r'| sqrt(2 Z) + kappa Z,      kappa = rho'/rho,   rho linear in each step,
//
// it is Z <= rho Y^2/2 and lambda (integral of e/rho) <= A + R Y at every time, Y = sqrt(2 A) + R,
// A = Z(0)/rho(0) + integral of delta/rho, R = integral of |r'|/sqrt(rho). Of all e that obey this the
// integral of sqrt(e) is largest where that of e/rho follows the greatest convex function below A + R Y, over
// the integral of rho (docs/bounds.md has the proofs).

/// Weights 1/rho of a step from time 0 to 1, with rho at both ends.
class StepWeights {
 public:
  StepWeights(double rho0, double rho1);

  /// At rest rho begins at 0: then only functions that do so, too, have an integral.
  [[nodiscard]] bool fromRest() const { return rho0_ == 0; }
  /// Integral of t^i/rho; infinite for 0 from rest.
  [[nodiscard]] double moment(int i) const { return moments_[i]; }
  /// 1/rho
  [[nodiscard]] double at(double t) const { return 1 / (rho0_ + t * (rho1_ - rho0_)); }
  /// Integral of 1/sqrt(rho).
  [[nodiscard]] double root() const;
  /// Mean of rho.
  [[nodiscard]] double length() const { return (rho0_ + rho1_) / 2; }

 private:
  double rho0_, rho1_;
  std::array<double, 3> moments_{};
};

/// The sums so far.
struct ErrorCourse {
  double growth = 1;  ///< rho at the end of the last step; 0 before the first one from rest
  double misfit = 0;  ///< A [J/m]
  double drift = 0;   ///< R [sqrt(J/m)]
  /// Corners of the greatest convex function: integral of rho [s], A + R Y there [J/m].
  std::vector<double> lengths{0}, sums{0};

  /// Weights of the next step, in which rho grows by a factor; from rest it is 1 at its end.
  [[nodiscard]] StepWeights weights(double factor) const;
  /// \param delta  integral of delta/rho over the step  \param change  of r in the step
  void add(const StepWeights& weights, double factor, double timeStep, double delta, double change);
  /// Of sqrt(2 Z).
  [[nodiscard]] double energyNorm() const;
  /// Of the integral of sqrt(e).
  [[nodiscard]] double rateIntegral(double lambda) const;
};

using PointMatrix = Eigen::Matrix<double, Eigen::Dynamic, Eigen::Dynamic, 0, 4, 4>;

struct FlowMisfit {
  double stress = 0;    ///< |s^ - s|^2 [J/m]
  double lift = 0;      ///< |a - s|^2 [J/m]
  double flow = 0;      ///< 2 k integral of D(s^; t) [J/m]
  double shift = 0;     ///< |k r - k G(s)|^2 [m^2]
  double norm = 0;      ///< |s|^2 [J/m]
  double strain = 0;    ///< |k G(s)|^2 [m^2]
  double fluidity = 0;  ///< 1/(2 lambda), the largest [1/(Pa s)]
};

/// Of a body on its matched mesh at a time.
struct RunFields {
  Matrix stress;        ///< s~, components x triangles [Pa]
  Matrix balanced;      ///< s^ at the vertices of the parts, components x 9 triangles [Pa]
  Vector displacement;  ///< u^ [m]
};

struct RunMisfit {
  std::vector<double> flow;  ///< integrals of D(s^; t)/rho over step and body, by weights [J/m]
  double change = 0;         ///< |r1 - r0|^2, r = s~ - s^ [J/m]
};

/// Of a state, beside a body of its own mesh.
class FlowingBody {
 public:
  explicit FlowingBody(const Body& own);

  /// Adds what a step does. \param weight  k [s]
  void addStep(const BodyState& state, const LoadedBody& loaded, const Vector& lifted, double weight,
               FlowMisfit& misfit) const;

  /// s^ and u^ of a state. \param weight  as that of `loaded` [s]
  [[nodiscard]] RunFields fields(const BodyState& state, const LoadedBody& loaded, const Vector& lifted,
                                 double weight) const;
  /// The fields at the start: s~ is the stress of the state, less what the lift takes from it.
  [[nodiscard]] RunFields start(const BodyState& state, const LoadedBody& loaded, const Vector& lifted) const;
  /// The same at rest, where all is zero.
  [[nodiscard]] RunFields rest(const CutMesh& cut) const;
  /// Those at the end of a step; adds what the step does.
  /// \param before,state  of the run at both ends  \param weight  as that of `loaded` [s]
  /// \param weights  those of the integrals
  RunFields step(const RunFields& fields, const BodyState& before, const BodyState& state,
                 const LoadedBody& loaded, const Vector& lifted, double timeStep, double weight,
                 const std::vector<StepWeights>& weights, RunMisfit& misfit) const;

  /// |s~ - s^|^2 [J/m]
  [[nodiscard]] double misfit(const RunFields& fields, const LoadedBody& loaded) const;
  /// |s - s^|^2 [J/m] and ||eps^_p - eps_p||^2 [m^2], s and eps_p those of the state.
  [[nodiscard]] std::array<double, 2> distance(const RunFields& fields, const BodyState& state,
                                               const LoadedBody& loaded) const;

 private:
  const Body& own_;
  std::vector<PointMatrix> compliances_, moduli_;  ///< E^-1 and E by triangles of the body
};

}  // namespace mortier
