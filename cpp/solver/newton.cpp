#include <algorithm>
#include <cmath>
#include <sstream>
#include <utility>

#include "base/counted.h"
#include "solver/methods.h"

namespace mortier {

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
  const std::vector<Body>& bodies = system.model().bodies;
  bool polish = std::any_of(bodies.begin(), bodies.end(), [](const Body& b) { return b.axisymmetric(); });
  int outOfBalance = 0;
  int corrections = 0;
  double balance = NAN;  // of the last iterate on the law
  StepOutcome outcome;
  prescribe(system.model(), step, iterate);
  StepSystem::Linearised linearised =
      system.linearise(step, iterate, limits.elasticFirst ? 0 : weight, limits.anticipate);
  while (true) {
    const double residual = linearised.residual();
    const bool far = residual > diverged && !limits.shortens;
    if (outcome.iterations == limits.iterations + corrections || !std::isfinite(residual) ||
        (far && outcome.iterations >= 2) ||
        (far && outcome.iterations == 1 && limits.turning && flows(system.model(), step.state0))) {
      std::ostringstream text;
      text << "Newton's method did not converge in " << counted(outcome.iterations, "iteration")
           << ", material residual " << residual;
      if (residual <= limits.tolerance) text << ", force balance " << balance;
      outcome.fail(Reason::unconverged, text.str());
      return outcome;
    }
    ++outcome.iterations;
    const std::optional<StepSystem::Factorised> factorised = linearised.factorise(outcome);
    const bool shortens = limits.shortens && outcome.iterations > 1;  // from where contact is solved
    const Iterate before = shortens ? iterate : Iterate{};
    const std::vector<Matrix> stressBefore =
        shortens ? stressesOnLaw(linearised, iterate) : std::vector<Matrix>{};
    if (!factorised || !factorised->solve(step, iterate, outcome)) return outcome;
    linearised = system.linearise(step, iterate, weight, limits.anticipate);
    if (shortens && linearised.residual() > limits.tolerance)
      linearised = shortened(system, step, weight, stressBefore, before, linearised, iterate);
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
    if (system.inSinglePrecision() && balance > rounded && !(balance > falls * lastBalance)) {
      ++corrections;
      continue;
    }
    if (balance > roundedInRings && outcome.iterations < limits.iterations + corrections &&
        std::exchange(polish, false))
      continue;
    if (balance <= std::max(balanceTolerance, limits.tolerance * 1e-2)) {
      outcome.converge(certificate);
      return outcome;
    }
    // The law holds and equilibrium does not, again and again: the linear solves are to blame.
    if (++outOfBalance == patience) system.useNextEngine();
  }
}

}  // namespace mortier
