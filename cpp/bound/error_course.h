// How an error grows in a run: with Z >= 0 and a rate e >= 0 such that
//
//   Z' + lambda e  <=  delta + |r'| sqrt(2 Z) + kappa Z,      kappa = rho'/rho,   rho linear in each step,
//
// it is Z <= rho Y^2/2 and lambda (integral of e/rho) <= A + R Y at every time, Y = sqrt(2 A) + R,
// A = Z(0)/rho(0) + integral of delta/rho, R = integral of |r'|/sqrt(rho). Of all e that obey this the
// integral of sqrt(e) is largest where that of e/rho follows the greatest convex function below A + R Y, over
// the integral of rho (docs/bounds.md has the proofs).
#pragma once

#include <array>
#include <vector>

namespace mortier {

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

}  // namespace mortier
