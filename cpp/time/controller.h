// Steps chosen by their error. `tolerance` is the error in time of every step of the run, relative to the largest
// displacement and stress of the run. What the error of one step may be follows from it by trial: a whole run is tried
// with a guess, its error estimated (step_taker.h), and tried again until that meets the tolerance; with N steps of a
// scheme of order p both errors are linked by  global ~ local^(p/(p+1)).  Within a run
//   k <- k 0.9 (error/local)^(-1/(p+1)),  by a factor between 1/5 and 5,
// and a step with a larger error is rejected. Steps end on the breaks of the plan and jump over no part of its data.
#pragma once

#include <vector>

#include "solver/model.h"
#include "solver/state.h"
#include "time/error_norms.h"
#include "time/memory.h"
#include "time/plan.h"
#include "time/step_taker.h"

namespace mortier {

class Controller {
 public:
  Controller(const Model& model, const TimePlan& plan, MarchMemory& memory);

  /// A few large steps of backward Euler to the end and back: only they tell how large the displacements of this run will
  /// be, of which early ones may be a tiny part. Makes the first guess of the error of a step.
  void pilot(StepTaker& taker, State& state);
  /// Makes ready for a run from the beginning.
  void begin(const State& state);
  /// Takes one step, or reports why there is none.
  void advance(StepTaker& taker, const State& state, StepReport& report);
  /// Whether the run as it ended meets the tolerance; otherwise another guess is made.
  bool adapt();
  /// The error of a step over the largest displacement and stress so far, or of the run where it is known.
  [[nodiscard]] double estimate() const;
  /// The same of the worst step so far.
  [[nodiscard]] double worst() const;

 private:
  [[nodiscard]] double nextTime(double t, double k) const;
  [[nodiscard]] double stopAfter(double t) const;
  void add(StepTaker& taker, std::vector<Matrix> local, double size);

  const TimePlan& plan_;
  MarchMemory& memory_;
  ErrorMeasure measure_;
  std::vector<double> nodes_;  ///< stage times of the scheme
  std::vector<double> stops_;  ///< breaks and the end
  double unseen_ = 0;          ///< part of a datum's range that a step may miss
};

}  // namespace mortier
