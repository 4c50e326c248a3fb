#include "time/step_taker.h"

#include <cmath>
#include <utility>

#include "time/measure.h"

namespace mortier {

StepTaker::StepTaker(const Model& model, State& state, MarchMemory& memory, Scheme scheme,
                     const SolverOptions& options)
    : model_(model), state_(state), memory_(memory), scheme_(scheme), solver_(model, options) {
  if (memory.run.steps > 0) solver_.resume(memory.libraries);
}

// An explicit or second-order scheme may overshoot into the elastic domain, where nothing brings the stress
// back. When the flow turns round between the stages in more than a small share of the bodies, the step is
// redone with backward Euler, which cannot.
StepOutcome StepTaker::attempt(double t1) {
  constexpr double turned = 0.05;
  t1_ = t1;
  StepOutcome outcome = solveStages(tableau(scheme_), t1);
  guarded_ = scheme_ == Scheme::sdirk2 && outcome.converged && turnedShare() > turned;
  if (guarded_) {
    memory_.increments.clear();
    StepOutcome again = solveStages(tableau(Scheme::backwardEuler), t1);
    again.iterations += outcome.iterations;
    again.factorisations += outcome.factorisations;
    outcome = std::move(again);
  }
  if (!outcome.converged) memory_.increments.clear();
  memory_.libraries = solver_.libraries();
  return outcome;
}

StepOutcome StepTaker::solveStages(const Tableau& scheme, double t1) {
  const double k = t1 - state_.time;
  rates_.clear();
  solutions_.clear();
  if (scheme.explicitFirst) rates_.push_back(ratesOf(solver_.start(state_)));
  StepOutcome total;
  for (size_t i = 0; i < scheme.stages.size(); ++i) {
    const Stage& stage = scheme.stages[i];
    StepData data{stage.time == 1 ? t1 : state_.time + stage.time * k, stage.diagonal * k, {}};
    shiftOf(stage, k);
    data.shift = shift_;
    Iterate iterate = guess(i, k, scheme.stages.size());
    StepOutcome outcome = solver_.solve(state_, data, iterate);
    outcome.iterations += total.iterations;
    outcome.factorisations += total.factorisations;
    outcome.certificate = worse(outcome.certificate, total.certificate);
    if (total.rung != "newton") outcome.rung = total.rung;
    total = std::move(outcome);
    if (!total.converged) return total;
    if (scheme.stages.size() > 1) rates_.push_back(ratesOf(iterate));
    solutions_.push_back(std::move(iterate));
  }
  return total;
}

/// sum_{j<i} a_ij k G_j
void StepTaker::shiftOf(const Stage& stage, double k) {
  shift_.clear();
  for (size_t b = 0; b < model_.bodies.size() && !stage.before.empty(); ++b) {
    shift_.push_back(Matrix::Zero(3, model_.bodies[b].points()));
    for (size_t j = 0; j < stage.before.size(); ++j)
      shift_[b] += stage.before[j] * k * rates_[j][b].topRows<3>();
  }
}

/// In steady flow the last increments are a good guess; a hard step before, or another step size, makes them
/// a bad one.
Iterate StepTaker::guess(size_t stage, double k, size_t stageCount) const {
  constexpr double sameStep = 1e-9;
  Iterate iterate = solver_.start(state_);
  if (memory_.increments.size() != stageCount || std::abs(memory_.timeStep - k) > sameStep * k)
    return iterate;
  for (size_t b = 0; b < model_.bodies.size(); ++b) {
    const BodyIncrement& last = memory_.increments[stage][b];
    iterate.bodies[b].increment = last.displacement;
    iterate.bodies[b].small = last.small;
    iterate.bodies[b].stress += last.stress;
  }
  return iterate;
}

std::vector<Matrix> StepTaker::ratesOf(const Iterate& iterate) const {
  std::vector<Matrix> rates(model_.bodies.size());
  for (size_t b = 0; b < model_.bodies.size(); ++b)
    model_.bodies[b].material().viscoplasticRate(iterate.bodies[b].stress, rates[b]);
  return rates;
}

/// Share of |G_1| in triangles where G_1 : G_2 <= 0.
double StepTaker::turnedShare() const {
  double all = 0;
  double against = 0;
  for (size_t b = 0; b < model_.bodies.size(); ++b)
    for (int i = 0; i < model_.bodies[b].points(); ++i) {
      const double flow = model_.bodies[b].weights()[i] * rates_[0][b].col(i).norm();
      all += flow;
      if (rates_[0][b].col(i).dot(rates_[1][b].col(i)) <= 0) against += flow;
    }
  return all > 0 ? against / all : 0;
}

void StepTaker::commit() {
  memory_.increments.clear();
  memory_.timeStep = t1_ - state_.time;
  for (size_t i = 0; i < solutions_.size(); ++i) {
    const bool last = i + 1 == solutions_.size();
    std::vector<BodyIncrement> increments;
    for (size_t b = 0; b < model_.bodies.size(); ++b) {
      BodyState& body = state_.bodies[b];
      BodyIterate& step = solutions_[i].bodies[b];
      if (last) body.displacement += step.increment + step.small;
      // The state takes the stress of the last stage, the memory the increments.
      if (last) step.stress.swap(body.stress);
      step.stress = last ? body.stress - step.stress : step.stress - body.stress;
      if (last && !model_.bodies[b].material().linear()) {
        // What the elastic part leaves of the strain of the step.
        Matrix elastic;
        model_.bodies[b].material().elasticStrain(step.stress, elastic);
        body.viscoplasticStrain -= elastic;
        body.viscoplasticStrain.topRows<3>() += step.strain;
        if (!shift_.empty()) body.viscoplasticStrain.topRows<3>() += shift_[b];
      }
      increments.push_back({std::move(step.increment), std::move(step.small), std::move(step.stress)});
    }
    if (!guarded_) memory_.increments.push_back(std::move(increments));
  }
  state_.contactForce = std::move(solutions_.back().contactForce);
  state_.time = t1_;
  active_ = std::move(solutions_.back().active);
  solutions_.clear();
}

}  // namespace mortier
