// Steps in which nothing happens: no load and no support changes, nothing flows, and the state still holds.
#include <algorithm>
#include <utility>

#include "solver/step.h"

namespace mortier {

const std::vector<Vector>& StepSolver::loadsAt(double time) {
  if (recentLoads_[0].time == time) return recentLoads_[0].forces;
  std::swap(recentLoads_[0], recentLoads_[1]);
  Loads& loads = recentLoads_[0];
  if (loads.time == time) return loads.forces;
  loads.time = time;
  loads.forces.clear();
  for (const Body& body : model_.bodies) loads.forces.push_back(body.load(time));
  return loads.forces;
}

/// Whether all loads and supports are the same, to the last bit, at both times.
bool StepSolver::sameData(double time, double other) {
  loadsAt(time);
  loadsAt(other);
  if (time != other && recentLoads_[0].forces != recentLoads_[1].forces) return false;
  return std::all_of(model_.bodies.begin(), model_.bodies.end(), [&](const Body& body) {
    Vector u = Vector::Zero(body.dofs());
    Vector v = u;
    body.prescribe(time, u);
    body.prescribe(other, v);
    return u == v;
  });
}

bool StepSolver::flows(const State& state) const {
  for (size_t b = 0; b < model_.bodies.size(); ++b)
    for (int i = 0; i < model_.bodies[b].points(); ++i)
      if (model_.bodies[b].material().flows(state.bodies[b].stress, i)) return true;
  return false;
}

/// Converged only where the state solves the step as it is; its certificate is made anew.
StepOutcome StepSolver::rest(const State& state0, const StepData& step, Iterate& solution) {
  constexpr double touching = 1e-14;
  StepOutcome outcome;
  outcome.rung = "rest";
  const auto none = [](const Matrix& shift) { return shift.isZero(0); };
  if (!sameData(state0.time, step.time) || flows(state0) ||
      !std::all_of(step.shift.begin(), step.shift.end(), none))
    return outcome;
  solution = start(state0);
  const double residual = linearise(state0, step, solution, false);
  for (size_t k = 0; k < model_.interfaces.size(); ++k) {
    const Vector& gap = state0.gap[k];
    const double size = extent(model_.bodies[model_.interfaces[k].pair().nonmortar.body].mesh());
    for (Eigen::Index i = 0; i < gap.size(); ++i)
      if (gap[i] < -touching * size) solution.active[k][i] = 0;
  }
  outcome.certificate = certify(state0, loadsAt(step.time), solution, residual);
  outcome.converged = residual <= options_.tolerance && outcome.certificate.forceBalance <= balanceTolerance;
  return outcome;
}

}  // namespace mortier
