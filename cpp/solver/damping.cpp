#include <algorithm>
#include <cmath>
#include <limits>

#include "solver/step.h"

namespace mortier {

// Where paths of solutions are a maze, the step is approached as the rest state of damped motion (pseudo-transient
// continuation, Kelley and Keyes 1998): beside the stress s on the law acts that of a viscosity in parallel,
//   s + E B (du - du_n)/delta,
// du_n where the motion was last. For small delta it makes the tangent that of an elastic body, whatever the law; where
// the motion ends it vanishes, so what is found solves the step. It goes down the stable side of folds, in steps that are
// solved roughly; delta, the length of one, doubles with each and falls where one cannot be solved.
StepOutcome StepSolver::damped(const State& state0, const StepData& step, int maxIterations,
                               Iterate& solution) {
  constexpr double shorter = 4;
  constexpr double longer = 2;
  constexpr double shortest = 1e-4;
  constexpr int iterations = 3;
  constexpr double roughly = 0.1;    // material residual of a step of the motion
  constexpr double nearRest = 0.02;  // stress of the damping, in yield stresses
  constexpr double hopeless = 1e3;
  constexpr int finishing = 7;

  StepOutcome total;
  const std::vector<Vector>& loads = loadsAt(step.time);
  Iterate rest = start(state0);
  prescribe(state0, step.time, rest);
  StepData elastic = step;
  elastic.weight = 0;
  linearise(state0, elastic, rest, false);
  std::vector<Matrix> moduli;
  std::vector<Matrix> strain0;
  for (size_t b = 0; b < systems_.size(); ++b) {
    moduli.push_back(systems_[b].moduli());
    strain0.push_back(rest.bodies[b].strain);
  }

  constexpr double unsolved = std::numeric_limits<double>::infinity();
  // One step of the motion from `rest`. \returns the largest stress of the damping, infinite where it was not solved.
  const auto advance = [&](double delta, Iterate& next) {
    for (int iteration = 0;; ++iteration) {
      const double residual = linearise(state0, step, next, true);
      if (iteration > 0 && residual <= roughly) break;
      if (iteration == iterations || !std::isfinite(residual) || (iteration >= 2 && residual > hopeless))
        return unsolved;
      ++total.iterations;
      for (size_t b = 0; b < systems_.size(); ++b)
        systems_[b].damp(moduli[b], delta, next.bodies[b].strain - strain0[b]);
      if (!factorise(total)) return unsolved;
      solveLinearised(state0, loads, next, total);
      if (!total.reason.empty()) return unsolved;
      forEachBody([&](int b) {
        BodyIterate& body = next.bodies[b];
        strain(step, b, body);
        body.stress -= systems_[b].dampingStress(moduli[b], delta, body.strain - strain0[b]);
      });
    }
    double largest = 0;
    for (size_t b = 0; b < systems_.size(); ++b) {
      const double unit = model_.bodies[b].material().stressScale();
      if (unit == 0) continue;
      const Matrix stress = systems_[b].dampingStress(moduli[b], delta, next.bodies[b].strain - strain0[b]);
      largest = std::max(largest, stress.cwiseAbs().maxCoeff() / unit);
    }
    return largest;
  };

  for (double delta = 1; total.iterations < maxIterations && delta > shortest;) {
    total.reason.clear();
    total.unheld = false;
    Iterate next = rest;
    const double damping = advance(delta, next);
    if (!std::isfinite(damping)) {
      delta /= shorter;
      continue;
    }
    rest = std::move(next);
    for (size_t b = 0; b < systems_.size(); ++b) strain0[b] = rest.bodies[b].strain;
    delta *= longer;
    if (damping > nearRest) continue;
    Iterate last = rest;
    StepOutcome outcome =
        newton(state0, step,
               {std::min(finishing, maxIterations - total.iterations), options_.tolerance, true}, last);
    total.iterations += outcome.iterations;
    total.factorisations += outcome.factorisations;
    if (!outcome.converged) continue;
    total.converged = true;
    total.certificate = outcome.certificate;
    solution = std::move(last);
    return total;
  }
  if (total.reason.empty())
    total.reason =
        "the damped motion did not come to rest in " + std::to_string(total.iterations) + " iterations";
  return total;
}

}  // namespace mortier
