#include <algorithm>
#include <cmath>
#include <utility>

#include "base/digits.h"
#include "solver/methods.h"

namespace mortier {

namespace {

/// Linear solves whose factors are not those of the tangent, or rounded, each completed.
class CompletedSolves {
 public:
  explicit CompletedSolves(StepSystem& system) : completes_(system.completes()) {}
  [[nodiscard]] bool completes() const { return completes_; }

  /// With the factors that there are, where that leads to the solution of the linear solve soon, else with
  /// new ones. \returns false where there is none; `outcome` then has the reason.
  bool solve(const StepSystem::Linearised& linearised, const Step& step, Iterate& iterate,
             StepOutcome& outcome) {
    constexpr int soon = 8;
    constexpr double roughly = 1e-2;
    constexpr double finely = 1e-10;
    constexpr double last = 1e-4;  // residual from which on the next linear solve may be the solution
    const double residual = linearised.residual();
    const double part = residual < last ? finely : std::min(0.1 * residual, roughly);
    const Iterate before = iterate;
    if (std::exchange(factorised_, true)) {
      StepOutcome tried;
      const StepSystem::Factorised older = linearised.keepFactors(true);
      if (older.solve(step, iterate, tried) && older.complete(step, before, part, soon, iterate)) return true;
      iterate = before;
    }
    const std::optional<StepSystem::Factorised> factorised = linearised.factorise(outcome);
    if (!factorised || !factorised->solve(step, iterate, outcome)) return false;
    factorised->complete(step, before, part, soon, iterate);
    return true;
  }

 private:
  bool completes_;
  bool factorised_ = false;
};

/// Whether gaps that rounding left of closed conditions are worth another linear solve.
bool worthCorrecting(const StepSystem& system, const Step& step, double tolerance, const Iterate& iterate) {
  // Sparse contact has its factors at hand and is always corrected.
  constexpr double ofTolerance = 1e-3;
  return system.gapRoundoff(step, iterate) > (system.sparse() ? 0 : ofTolerance * tolerance);
}

/// That, with the same factors. \returns the certificate of what it made of the iterate; none, and the
/// iterate as it was, where that is no better.
std::optional<Certificate> corrected(StepSystem& system, const StepSystem::Linearised& linearised,
                                     const Step& step, double weight, const NewtonLimits& limits,
                                     Iterate& iterate) {
  Iterate next = iterate;
  StepOutcome outcome;
  if (!linearised.keepFactors().solve(step, next, outcome)) return std::nullopt;
  const double residual = system.linearise(step, next, weight, limits.anticipate).residual();
  if (!(residual <= limits.tolerance)) return std::nullopt;
  if (!(system.gapRoundoff(step, next) < system.gapRoundoff(step, iterate))) return std::nullopt;
  const Certificate certificate = system.certify(step, next, residual);
  iterate = std::move(next);
  return certificate;
}

/// Of each body: stresses on the law, linearised where the strain leads: there the predictor is on it.
std::vector<Matrix> stressesOnLaw(const StepSystem::Linearised& linearised, size_t bodies) {
  std::vector<Matrix> stresses;
  for (size_t b = 0; b < bodies; ++b) stresses.push_back(linearised.law(static_cast<int>(b)).predictor);
  return stresses;
}

/// Where the slope of the energy at the end of a linear solve is positive, and more than half of that at its
/// beginning `before`: moves the iterate back to where the slope is nearly zero.
/// \param linearised  at the iterate  \returns the law there
StepSystem::Linearised searchLine(StepSystem& system, const Step& step, double weight,
                                  const std::vector<Matrix>& stressBefore, const Iterate& before,
                                  StepSystem::Linearised linearised, Iterate& iterate) {
  constexpr double flat = 0.5;  // of the slope at the beginning
  constexpr int most = 12;
  const Model& model = system.model();
  const Iterate end = iterate;
  double overlap = 0;
  const std::vector<Vector> gapsBefore = gaps(model, step.gap0(), before);
  for (size_t k = 0; k < gapsBefore.size(); ++k) overlap += end.contactForce[k].dot(gapsBefore[k]);
  const std::vector<Vector> jumpsBefore = jumps(model, step.state0, before);
  for (size_t k = 0; k < jumpsBefore.size(); ++k) overlap += end.tieForce[k].dot(jumpsBefore[k]);
  const auto slope = [&](const std::vector<Matrix>& stress) {
    double work = 0;
    for (size_t b = 0; b < stress.size(); ++b) {
      const Matrix way = end.bodies[b].strain - before.bodies[b].strain;
      const std::vector<double>& weights = model.bodies[b].weights();
      for (Eigen::Index i = 0; i < way.cols(); ++i)
        work += weights[i] * (stress[b].col(i) - end.bodies[b].stress.col(i)).dot(way.col(i));
    }
    return work + overlap;
  };
  const double first = slope(stressBefore);
  double low = 0;
  double high = 1;
  double length = 1;
  for (int i = 0; i < most; ++i) {
    const std::vector<Matrix> stress = stressesOnLaw(linearised, iterate.bodies.size());
    if (i > 0)
      for (size_t b = 0; b < stress.size(); ++b) iterate.bodies[b].stress = stress[b];
    const double here = slope(stress);
    if (!(first < 0) || std::abs(here) <= -flat * first || (length == 1 && here < 0)) break;
    (here > 0 ? high : low) = length;
    length = (low + high) / 2;
    for (size_t b = 0; b < iterate.bodies.size(); ++b) {
      TwoPartVector& increment = iterate.bodies[b].increment;
      increment = before.bodies[b].increment;
      increment += length * end.bodies[b].increment.minus(increment);
    }
    for (size_t k = 0; k < end.contactForce.size(); ++k)
      iterate.contactForce[k] =
          before.contactForce[k] + length * (end.contactForce[k] - before.contactForce[k]);
    for (size_t k = 0; k < end.tieForce.size(); ++k)
      iterate.tieForce[k] = before.tieForce[k] + length * (end.tieForce[k] - before.tieForce[k]);
    linearised = system.linearise(step, iterate, weight, true);
  }
  return linearised;
}

}  // namespace

StepOutcome newton(StepSystem& system, const Step& step, double weight, const NewtonLimits& limits,
                   Iterate& iterate) {
  // Beyond this many times the stresses that are there, or the yield stress, an iterate does not come back.
  constexpr double diverged = 1e3;
  constexpr double cancelling = 10;
  constexpr int patience = 2;
  // Triangles far from an axis are the stiffest, as theirs are the widest rings, while contact next to it has
  // the forces: what a solve rounds there is more than elsewhere, and is gone after another one.
  constexpr double roundedInRings = 1e-12;
  // What single precision leaves falls with each solve, until it is rounding.
  constexpr double falls = 0.25;
  constexpr double rounded = 1e-15;
  constexpr double balanced = 1e-13;  // by solves that are completed
  const std::vector<Body>& bodies = system.model().bodies;
  bool polish = std::ranges::any_of(bodies, &Body::axisymmetric);
  int outOfBalance = 0;
  int corrections = 0;
  double balance = NAN;  // of the last iterate on the law
  StepOutcome outcome;
  CompletedSolves solves(system);
  const bool completes = limits.lineSearch && solves.completes();
  prescribe(system.model(), step, iterate);
  StepSystem::Linearised linearised =
      system.linearise(step, iterate, limits.elasticFirst ? 0 : weight, limits.anticipate);
  while (true) {
    const double residual = linearised.residual();
    const bool far = residual > diverged && !limits.lineSearch;
    if (outcome.iterations == limits.iterations + corrections || !std::isfinite(residual) ||
        (far && outcome.iterations >= 2) ||
        (far && outcome.iterations == 1 && limits.giveUpOnReversal && flows(system.model(), step.state0))) {
      std::string text = "Newton's method did not converge in " + counted(outcome.iterations, "iteration") +
                         ", material residual " + digits(residual, 6);
      if (residual <= limits.tolerance) text += ", force balance " + digits(balance, 6);
      outcome.fail(Reason::unconverged, text);
      return outcome;
    }
    ++outcome.iterations;
    const bool lineSearch = limits.lineSearch && outcome.iterations > 1;  // from where contact is solved
    const Iterate before = lineSearch ? iterate : Iterate{};
    const std::vector<Matrix> stressBefore =
        lineSearch ? stressesOnLaw(linearised, iterate.bodies.size()) : std::vector<Matrix>{};
    if (completes) {
      if (!solves.solve(linearised, step, iterate, outcome)) return outcome;
    } else {
      const std::optional<StepSystem::Factorised> factorised = linearised.factorise(outcome);
      if (!factorised || !factorised->solve(step, iterate, outcome)) return outcome;
    }
    linearised = system.linearise(step, iterate, weight, limits.anticipate);
    if (lineSearch && linearised.residual() > limits.tolerance)
      linearised = searchLine(system, step, weight, stressBefore, before, linearised, iterate);
    // A stress that was far off the law has come back by cancellation. What that rounds stays in stiff
    // triangles, unseen by the residual, until an iteration has nothing to cancel.
    if (!(linearised.residual() <= limits.tolerance) || residual > cancelling) continue;
    Certificate certificate = system.certify(step, iterate, linearised.residual(), outOfBalance >= patience);
    if (worthCorrecting(system, step, limits.tolerance, iterate)) {
      if (const auto better = corrected(system, linearised, step, weight, limits, iterate))
        certificate = *better;
      else
        linearised = system.linearise(step, iterate, weight, limits.anticipate);
    }
    const double lastBalance = std::exchange(balance, certificate.forceBalance);
    const bool falling = !(balance > falls * lastBalance);
    if ((completes ? balance > balanced : system.inSinglePrecision() && balance > rounded) && falling) {
      ++corrections;
      continue;
    }
    if (balance > roundedInRings && outcome.iterations < limits.iterations + corrections &&
        std::exchange(polish, false))
      continue;
    const bool closed = certificate.gapOnActive <= std::max(residualTolerance, limits.tolerance);
    if (closed && balance <= std::max(balanceTolerance, limits.tolerance * 1e-2)) {
      outcome.converge(certificate);
      return outcome;
    }
    // The law holds, equilibrium or contact do not, again and again: the linear solves are to blame.
    if (++outOfBalance == patience) system.useNextEngine();
  }
}

}  // namespace mortier
