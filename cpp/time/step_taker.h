// One step in time: the stages of the scheme, the guard, and an estimate of the error.
#pragma once

#include <optional>
#include <tuple>
#include <utility>
#include <vector>

#include "solver/model.h"
#include "solver/solve_step.h"
#include "solver/state.h"
#include "time/memory.h"
#include "time/overlap_check.h"
#include "time/scheme.h"

namespace mortier {

/// An error (exact less computed) at the end of a step.
struct StepError {
  std::vector<Matrix> strain;      ///< of the viscoplastic strain, per body
  std::vector<Response> response;  ///< of displacement and stress
};

class StepTaker {
 public:
  /// \param countsWork  whether commit() adds to the work done on bodies (count_work.cpp)
  /// \param overlapEnds  whether an overlap of bodies that nothing explains refuses an attempt
  /// \throws UnheldBodyError when nothing holds a body.
  StepTaker(const Model& model, State& state, MarchMemory& memory, Scheme scheme,
            const SolverOptions& options, bool countsWork = false, bool overlapEnds = true);

  /// Solves the step from the state to `t1`. The state is not changed before commit().
  StepOutcome attempt(double t1, Effort effort = Effort::usual) { return attempt(t1, scheme_, effort); }
  /// The same with another scheme.
  StepOutcome attempt(double t1, Scheme scheme, Effort effort = Effort::usual);
  /// Lets the data of the state's time act at once: a step of length zero, in which nothing flows. Where it
  /// is solved it is the state.
  StepOutcome jump();
  /// Whether the last attempt, which converged, needs the guard.
  [[nodiscard]] bool flowReversed() const;
  /// Repeats it as two half steps of backward Euler. \returns the outcome, the work of `before` included
  StepOutcome guard(const StepOutcome& before, Effort effort = Effort::usual);
  /// Whether that was done.
  [[nodiscard]] bool guarded() const { return guarded_; }
  /// The error that the last attempt makes on its way from the state (step_error.cpp).
  StepError localError();
  /// What an error of the viscoplastic strain at the start of the attempt, and of the slip of the nodes that
  /// stick, has become at its end: the stress of that slip relaxes.
  StepError carried(const std::vector<Matrix>& strain, const std::vector<Vector>& slip = {});
  /// Whether a contact that was open is closed at the end of the last attempt.
  [[nodiscard]] bool closes() const;
  /// Whether any contact opens, closes, sticks or slips there that did not in the state.
  [[nodiscard]] bool contactChanges() const;
  /// The error of the state from which the last attempt begins, as far as its stresses relax within the
  /// attempt: its flow is not that with which the attempt begins.
  std::vector<Response> lagAtStart();
  /// What displacement and stress make of an error of the viscoplastic strain at the end of the attempt, and
  /// of the slip of the nodes that stick there; of no strain where that is empty.
  std::vector<Response> response(const std::vector<Matrix>& strain, const std::vector<Vector>& slip = {});
  /// Slip, dissipation by friction and flow of the last attempt.
  [[nodiscard]] SlipAndWork slip() const;
  /// What nodes that close in the last attempt, and stick at its end, slip before they close: the attempt
  /// holds them where it begins.
  [[nodiscard]] std::vector<Vector> slipBeforeClosing() const;
  /// What the friction of the last attempt dissipates more where its nodes slip so much more [J/m].
  [[nodiscard]] double workAlong(const std::vector<Vector>& slip) const;
  /// The slip that such a response has, per interface.
  [[nodiscard]] std::vector<Vector> slipOf(const std::vector<Response>& response) const;
  [[nodiscard]] bool follows() const { return anyFollows(model_); }
  /// What commit() changes.
  using Kept = std::pair<State, MarchMemory>;
  [[nodiscard]] Kept kept() const { return {state_, memory_}; }
  void goBack(Kept kept) {
    std::tie(state_, memory_) = std::move(kept);
    showState();
  }
  /// Rows that follow the bodies become those of the state, for whoever measures it while an attempt is not
  /// committed yet.
  void showState() {
    if (!follows()) return;
    follow(model_, displacementsOf(state_));
    keepRows();
    showsState_ = true;
  }
  /// Of the state, what nearFacingLimit() says (facing_limit.h); rows become those of the state.
  std::string nearFacingLimit();
  /// What the stress changes by from the start of the attempt to one of its stages; no displacement.
  [[nodiscard]] std::vector<Response> change(size_t stage) const;
  [[nodiscard]] size_t stages() const { return tableau_.stages.size(); }
  /// Where points began to flow during the attempt, about the error of their stress at its end: stages before
  /// that have no flow, the others only its last direction. No displacement.
  [[nodiscard]] std::vector<Response> turn() const;
  /// The fraction of the attempt at which the first point flows, where none did at its start; 1 if none does.
  [[nodiscard]] double onset() const;
  /// Part of the points that can flow that do so in the state.
  [[nodiscard]] double flowing() const;
  /// The same at the end of the attempt.
  [[nodiscard]] double flowingAtEnd() const;
  /// Power of the step with which the local error falls.
  [[nodiscard]] int errorOrder() const { return tableau_.errorOrder; }
  /// Where the last attempt is furthest off the material law, if it was not solved.
  [[nodiscard]] std::optional<StuckPlace> stuck();
  /// The stress of its iterate there, in words.
  [[nodiscard]] std::string stressAt(const StuckPlace& place) const;
  /// The special contact conditions that were found so far.
  [[nodiscard]] const SpecialConditions& special() const { return system_.special(); }
  /// The deepest overlap of bodies at the end of the last attempt that was solved.
  [[nodiscard]] const BodyOverlap& overlap() const { return overlap_; }
  StepSolutions takeSolutions() { return system_.takeSolutions(); }
  /// Makes the result of the last attempt the state.
  void commit();
  [[nodiscard]] Threads& threads() { return system_.threads(); }
  [[nodiscard]] StepSystem& system() { return system_; }
  [[nodiscard]] const State& state() const { return state_; }
  /// Active sets of the last step.
  [[nodiscard]] const ActiveSets& active() const { return active_; }

 private:
  StepOutcome solveStages(double t1, Effort effort);
  StepOutcome hold(StepOutcome outcome);
  /// By the boundaries of the bodies alone.
  [[nodiscard]] BodyOverlap overlapOf(const Iterate& iterate, double time);
  /// solveStep(), repeated where contact follows the bodies (follow_bodies.cpp).
  StepOutcome solveStage(StepData& data, Iterate& iterate, Effort effort);
  StepOutcome repeatOnMovedBodies(StepData& data, Iterate& iterate, Effort effort);
  std::vector<Vector> followTo(const std::vector<Vector>& increments, bool keepRows);
  std::vector<Vector> followTo(const Iterate& iterate);
  /// What friction dissipates in the last attempt, per interface [J/m].
  [[nodiscard]] std::vector<double> dissipatedByFriction() const;
  void keepRows();
  Iterate guess(size_t stage, double k);
  void shiftOf(const Stage& stage, double k);
  /// G at the start of the step.
  [[nodiscard]] std::vector<Matrix> startingRates() const;
  /// G of a solved stage, `weight` its time step times its diagonal coefficient [s].
  [[nodiscard]] std::vector<Matrix> ratesOf(const Iterate& stage, double weight) const;
  /// What the step makes of strains given at its stages.
  std::vector<Matrix> throughStages(const std::vector<std::vector<Matrix>>& strains,
                                    const std::vector<Vector>& slip = {});
  [[nodiscard]] std::vector<Matrix> flowOf(const std::vector<Matrix>& strain,
                                           const std::vector<Response>& response) const;
  [[nodiscard]] std::vector<Matrix> defects(size_t body, const std::vector<Matrix>& rates) const;
  using Fields = std::vector<std::vector<Matrix>>;  ///< by stage and body
  void limit(const Fields& rates, Fields& missed) const;
  StepError atEnd(std::vector<Matrix> strain, const std::vector<Vector>& slip = {});
  [[nodiscard]] Matrix strainAtTangent(size_t body, const Matrix& strain) const;
  void onlyWhereItFlows(size_t stage, std::vector<Matrix>& flow) const;
  void addLag(const Fields& rates, std::vector<Response>& response);
  [[nodiscard]] Fields stageRates() const;
  [[nodiscard]] Matrix rateOf(const Fields& rates, size_t body, double fraction) const;
  std::vector<Response> lag(std::vector<Matrix> strain);
  [[nodiscard]] Matrix stressWithin(size_t body, double fraction) const;
  [[nodiscard]] Matrix strainWithin(size_t body, double fraction) const;
  [[nodiscard]] double reversedShare() const;
  [[nodiscard]] double dissipated(size_t body) const;
  void countWork();
  [[nodiscard]] std::vector<Matrix> extrapolatedStress() const;
  [[nodiscard]] double share(double fraction) const;

  const Model& model_;
  State& state_;
  MarchMemory& memory_;
  Scheme scheme_;
  StepSystem system_;
  std::vector<std::array<ConstraintRows, 2>> rowsBefore_;  ///< T of the state where rows follow the bodies
  bool showsState_ = false;  ///< whether rows that follow are those of the state, not of the attempt
  bool countsWork_;
  bool overlapEnds_;
  std::optional<OverlapCheck> overlapCheck_;
  // Of the last attempt:
  Tableau tableau_;
  std::vector<Iterate> solutions_;                        ///< by stage
  std::vector<Vector> frictionAtSlip_;                    ///< of the last attempt that converged
  std::vector<Vector> gap0_;                              ///< of the state, by the rows of the last stage
  std::optional<std::pair<StepData, Iterate>> unsolved_;  ///< the stage that was not
  std::vector<std::vector<Matrix>> rates_;                ///< G by stage and body
  std::vector<Matrix> shift_;                             ///< of the last stage
  std::vector<Response> reached_;                         ///< of the error last taken through the stages
  BodyOverlap overlap_;
  double t1_ = 0;
  bool guarded_ = false;
  bool startSolved_ = false;  ///< the state is the end of a step
  ActiveSets active_;
};

}  // namespace mortier
