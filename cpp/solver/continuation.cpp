#include <algorithm>
#include <cmath>
#include <deque>

#include "solver/step.h"

namespace mortier {

// Where a step may have several solutions, the one at the end of this path is meant: the step is solved with the
// viscosity raised so far that the bodies are almost elastic, then lowered by
// less than half a decade (longer stages jump off the path), each stage begun from the last and solved roughly. Where a stage fails, the path goes
// back by two and is followed more closely.
StepOutcome StepSolver::continuation(const State& state0, const StepData& step, int maxIterations,
                                     Iterate& solution) {
  constexpr double firstStiffness = 0.3;
  constexpr double decades = 0.4;
  constexpr double closer = 1.5;
  constexpr double finestPace = 0.02;
  constexpr int stageIterations = 4;
  constexpr double finestTolerance = 1e-8;
  constexpr int lastIterations = 20;
  constexpr int stagesBack = 2;

  struct Stage {
    double decadesLeft = 0;
    Iterate iterate;
  };
  double stiffness = 0;
  for (const Body& body : model_.bodies)
    stiffness = std::max(stiffness, body.material().stiffness(step.weight));
  double pace = decades;
  double tolerance = 0.3;
  std::deque<Stage> path{{std::log10(stiffness / firstStiffness) + pace, start(state0)}};
  StepOutcome total;
  while (total.iterations < maxIterations) {
    Stage stage = path.back();
    stage.decadesLeft = std::max(0.0, stage.decadesLeft - pace);
    const bool last = stage.decadesLeft == 0;
    StepData eased = step;
    eased.weight = step.weight * std::pow(10, -stage.decadesLeft);
    const int iterations =
        std::min(last ? lastIterations : stageIterations, maxIterations - total.iterations);
    StepOutcome outcome =
        newton(state0, eased, {iterations, last ? options_.tolerance : tolerance, true}, stage.iterate);
    outcome.iterations += total.iterations;
    outcome.factorisations += total.factorisations;
    total = std::move(outcome);
    if (total.converged) {
      path.push_back(std::move(stage));
      if (last) break;
      if (path.size() > 2 * stagesBack + 1) path.erase(path.begin() + 1);
      continue;
    }
    tolerance = std::max(finestTolerance, tolerance / 10);
    pace = std::max(finestPace, pace / closer);
    for (int i = 0; i < stagesBack && path.size() > 1; ++i) path.pop_back();
  }
  total.converged = total.converged && path.back().decadesLeft == 0;
  if (!total.converged && !total.unheld)
    total.reason = "the viscosity could not be lowered to that of the step in " +
                   std::to_string(total.iterations) + " iterations" +
                   (total.reason.empty() ? "" : ", " + total.reason);
  solution = std::move(path.back().iterate);
  return total;
}

}  // namespace mortier
