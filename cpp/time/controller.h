// Steps chosen by their error. `tolerance` is the error in time of every step of the run, relative to the
// largest displacement and stress of the run. What the error of one step may be follows from it by trial: a
// run is tried with a guess, its error estimated (step_taker.h), and begun again with a smaller one until
// that meets the tolerance; with N steps of a scheme of order p both errors are linked by
//   global ~ local^(p/(p+1)).
// Within a run
//   k <- k 0.9 (error/local)^(-1/(p+1)),  by a factor between 1/5 and 5,
// and a step with a larger error is rejected. Where steps may end: step_ends.h.
//
// Where there is friction only the slip of a whole step counts, and what a step misses of it no stage of the
// step shows. So steps come in pairs, and a pair is good if one step of twice the length differs from it by
// no more than the error that a step may have (slip_control.cpp).
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "solver/model.h"
#include "solver/state.h"
#include "time/error_norms.h"
#include "time/memory.h"
#include "time/plan.h"
#include "time/step_ends.h"
#include "time/step_taker.h"

namespace mortier {

class Controller {
 public:
  Controller(const Model& model, const TimePlan& plan, MarchMemory& memory);

  /// A few large steps of backward Euler to the end and back: only they show how large the displacements of
  /// this run will be, of which early ones may be a tiny part. Makes the first guess of the error of a step.
  void pilot(StepTaker& taker, State& state);
  /// Prepares a run from the beginning.
  void begin(const State& state);
  /// Takes one step, or reports why there is none.
  void advance(StepTaker& taker, const State& state, StepReport& report);
  /// Whether the run so far is too inaccurate to be continued: it has cost twice what it took to pass the
  /// tolerance, so that by how much it does is known.
  bool abandons();
  /// Goes back to the beginning with another guess, unless the run meets the tolerance or was the last trial.
  bool beginAgain(State& state);
  /// The error of the worst step so far over the largest displacement and stress so far.
  [[nodiscard]] double worst() const;
  /// Why the run as it ended does not meet the tolerance; empty where it does.
  [[nodiscard]] std::string shortfall() const;

 private:
  static constexpr double safety = 0.9;
  static constexpr double largestFactor = 5;
  static constexpr double leastFactor = 0.2;
  static constexpr double failureFactor = 0.25;
  static constexpr int trials = 10;
  /// What is known of an attempt that converged.
  struct Judgement {
    StepError local;                ///< its error
    double size = 0;                ///< of that, relative
    double change = 0;              ///< of the stress from the start to a stage, relative
    double factor = largestFactor;  ///< by which the next step may be longer
    bool good = true;
  };
  /// One that was made.
  struct Attempt {
    double t1 = 0;
    StepOutcome outcome = {};
    Judgement judgement = {};
    SlipAndWork missed = {};  ///< by one step over the pair that it begins; the second is still to be added
    bool beginsPair = false;
    bool contactChanges = false;
  };
  [[nodiscard]] Judgement judge(StepTaker& taker, double t0, double t1) const;
  /// \param onsets  how often the step may still be shortened to end on the first onset of flow
  StepOutcome attempt(StepTaker& taker, double t0, double t1, int onsets, Judgement& judgement);
  /// \param end  of the step, or of the pair that it begins
  Attempt attemptOfPair(StepTaker& taker, double t0, double end, int onsets);
  /// Solves the second step of a pair, to `end`, and compares the pair with one step.
  /// \returns whether it is good \param factor  by which the next pair may be longer
  bool completePair(StepTaker& taker, const Attempt& first, double end, StepReport& report, double& factor);
  static void addOfPair(const StepTaker& taker, const Judgement& of, SlipAndWork& missed);
  [[nodiscard]] bool inPair(double t) const { return memory_.controller.pairEnd > t; }
  /// Takes the step from `start` again as two half steps (closing_control.cpp).
  /// \param closing  its length where contact closes in it, else 0
  /// \returns whether these are good; where not, the state is the one at the start and `factor` the part of
  /// the step that may be
  bool repeatInHalves(StepTaker& taker, StepTaker::Kept start, const State& state, double closing,
                      StepReport& report, double& factor);
  [[nodiscard]] double closingTimeError(StepTaker& taker, double t, double k, StepReport& report) const;
  double halve(StepTaker& taker, const StepTaker::Kept& start, const State& state, StepReport& report);
  [[nodiscard]] bool turnsTooFar(const StepTaker& taker) const;
  /// What that is of what is computed, relative.
  [[nodiscard]] double sizeOf(StepTaker& taker, const SlipAndWork& missed) const;
  [[nodiscard]] double leastStep(double t) const;
  [[nodiscard]] bool isShortest(double t, double k) const;
  [[nodiscard]] bool stepsTooSmall(double t, double k) const;
  void carrySlip(const StepTaker& taker, std::vector<Vector> slip);
  void add(StepTaker& taker, StepError local, double size, SlipAndWork missed);

  const TimePlan& plan_;
  MarchMemory& memory_;
  ErrorMeasure measure_;
  StepEnds ends_;
  double dataTolerance_ = 0;  ///< part of a datum's range that a step may miss
  bool hasFriction_ = false;  ///< whether there is friction
  bool flows_ = false;        ///< whether any body can flow
  /// The second step of a pair whose first one has been taken: solved, not committed.
  std::optional<Attempt> second_;
};

}  // namespace mortier
