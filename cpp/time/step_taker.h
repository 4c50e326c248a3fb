// One step in time: the stages of the scheme, and the guard.
#pragma once

#include <vector>

#include "solver/model.h"
#include "solver/state.h"
#include "solver/step.h"
#include "time/memory.h"
#include "time/scheme.h"

namespace mortier {

class StepTaker {
 public:
  /// \throws UnheldBodyError when nothing holds a body.
  StepTaker(const Model& model, State& state, MarchMemory& memory, Scheme scheme,
            const SolverOptions& options);

  /// Solves the step from the state to `t1`. The state is not changed before commit().
  StepOutcome attempt(double t1);
  /// Takes the last attempt over.
  void commit();
  /// Active sets of the last attempt.
  [[nodiscard]] const ActiveSets& active() const { return active_; }

 private:
  StepOutcome solveStages(const Tableau& scheme, double t1);
  [[nodiscard]] Iterate guess(size_t stage, double k, size_t stageCount) const;
  void shiftOf(const Stage& stage, double k);
  [[nodiscard]] std::vector<Matrix> ratesOf(const Iterate& iterate) const;
  [[nodiscard]] double turnedShare() const;

  const Model& model_;
  State& state_;
  MarchMemory& memory_;
  Scheme scheme_;
  StepSolver solver_;
  std::vector<Iterate> solutions_;          ///< of the stages of the last attempt
  std::vector<std::vector<Matrix>> rates_;  ///< G of its stages, per body
  std::vector<Matrix> shift_;               ///< of its last stage
  ActiveSets active_;
  double t1_ = 0;
  bool guarded_ = false;
};

}  // namespace mortier
