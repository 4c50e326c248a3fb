// One step in time: the stages of the scheme, the guard, and an estimate of the error.
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
  StepOutcome attempt(double t1, Effort effort = Effort::usual) { return attempt(t1, scheme_, effort); }
  /// The same with another scheme.
  StepOutcome attempt(double t1, Scheme scheme, Effort effort = Effort::usual);
  /// Whether the last attempt was done again as two half steps of backward Euler.
  [[nodiscard]] bool guarded() const { return guarded_; }
  /// Estimate of the local error of the last attempt, per body: the embedded estimate of the viscoplastic strain,
  /// filtered through the tangent at the end of the step with the contact kept as it is. Where steps are longer
  /// than the relaxation time, that is the error of the overstress. What is `lasting` of it is filtered once more:
  /// the rest is forgotten in the next steps.
  std::vector<Response> error(bool lasting);
  /// Power of the step with which that falls.
  [[nodiscard]] int errorOrder() const { return tableau_.errorOrder; }
  /// What was met among the contact conditions so far.
  [[nodiscard]] const SpecialConditions& special() const { return solver_.special(); }
  /// Takes the last attempt over.
  void commit();
  /// Active sets of the last step.
  [[nodiscard]] const ActiveSets& active() const { return active_; }

 private:
  StepOutcome solveStages(double t1, Effort effort);
  [[nodiscard]] Iterate guess(size_t stage, double k) const;
  void shiftOf(const Stage& stage, double k);
  /// G at the start of the step.
  [[nodiscard]] std::vector<Matrix> startingRates() const;
  /// G of a solved stage, `weight` its time step times its diagonal coefficient [s].
  [[nodiscard]] std::vector<Matrix> ratesOf(const Iterate& stage, double weight) const;
  [[nodiscard]] std::vector<Matrix> strainError();
  void judgeOnset(const Matrix& rate0, const Matrix& rate1, const Matrix& rate2, double k,
                  Matrix& error) const;
  [[nodiscard]] double turnedShare() const;

  const Model& model_;
  State& state_;
  MarchMemory& memory_;
  Scheme scheme_;
  StepSolver solver_;
  // Of the last attempt:
  Tableau tableau_;
  std::vector<Iterate> solutions_;          ///< by stage
  std::vector<std::vector<Matrix>> rates_;  ///< G by stage and body
  std::vector<Matrix> shift_;               ///< of the last stage
  double t1_ = 0;
  bool guarded_ = false;
  ActiveSets active_;
};

}  // namespace mortier
