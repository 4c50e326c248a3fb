// Steps chosen by their error. The estimate of a step (step_taker.h) is measured in two norms, each over a
// scale of the run: the stress in the energy norm, which is blind where equilibrium alone decides the stress,
// and the displacement in the mean. With err their maximum over the tolerance,
//   k <- k 0.9 err^(-1/order), by a factor between 1/5 and 5,
// and a step with err > 1 is rejected. Steps end on the breaks of the plan.
#pragma once

#include <vector>

#include "solver/model.h"
#include "solver/state.h"
#include "time/memory.h"
#include "time/plan.h"
#include "time/step_taker.h"

namespace mortier {

class Controller {
 public:
  Controller(const Model& model, const TimePlan& plan, MarchMemory& memory);

  /// A few large steps of backward Euler to the end and back: only they tell how large the displacements of
  /// this run will be, of which early ones may be a tiny part.
  void pilot(StepTaker& taker, State& state);
  /// Takes one step that meets the tolerance, or reports why there is none.
  void advance(StepTaker& taker, const State& state, StepReport& report);

 private:
  [[nodiscard]] double nextTime(double t) const;
  [[nodiscard]] double stopAfter(double t) const;
  void rescale(const State& state);
  [[nodiscard]] double measured(const std::vector<Response>& error) const;
  struct Norms {
    double energy = 0;  ///< square of the energy norm of a stress [J/m]
    double strain = 0;  ///< mean square of its elastic strain [-]
  };
  [[nodiscard]] Norms normsOf(const Matrix& stress, size_t body) const;
  [[nodiscard]] double meanSquare(const Vector& displacement, size_t body) const;

  const Model& model_;
  const TimePlan& plan_;
  MarchMemory& memory_;
  std::vector<double> stops_;  ///< breaks and the end
  double area_ = 0;            ///< of all bodies [m^2]
  double extent_ = 0;          ///< of the largest [m]
};

}  // namespace mortier
