#include "time/controller.h"

#include <algorithm>
#include <cmath>
#include <sstream>

#include "time/measure.h"

namespace mortier {
namespace {

constexpr double safety = 0.9;
constexpr double leastFactor = 0.2;
constexpr double largestFactor = 5;
constexpr double failureFactor = 0.25;

}  // namespace

Controller::Controller(const Model& model, const TimePlan& plan, MarchMemory& memory)
    : model_(model), plan_(plan), memory_(memory) {
  for (const Body& body : model.bodies) {
    for (const double weight : body.weights()) area_ += weight;
    extent_ = std::max(extent_, extent(body.mesh()));
  }
  for (const double t : plan.breaks)
    if (t > memory.begin && t < plan.end) stops_.push_back(t);
  stops_.push_back(plan.end);
}

double Controller::stopAfter(double t) const {
  return *std::upper_bound(stops_.begin(), stops_.end() - 1, t);
}

/// To the next stop in one step if it is near, in two if it is not far.
double Controller::nextTime(double t) const {
  constexpr double stretch = 1.1;
  const double stop = stopAfter(t);
  const double k = memory_.controller.timeStep;
  if (stop - t <= stretch * k) return stop;
  return stop - t <= 2 * k ? t + (stop - t) / 2 : t + k;
}

Controller::Norms Controller::normsOf(const Matrix& stress, size_t body) const {
  Matrix strain;
  model_.bodies[body].material().elasticStrain(stress, strain);
  Norms norms;
  for (Eigen::Index i = 0; i < stress.cols(); ++i) {
    const double weight = model_.bodies[body].weights()[i];
    norms.energy += weight * stress.col(i).dot(strain.col(i));
    norms.strain += weight / area_ * strain.col(i).squaredNorm();
  }
  return norms;
}

/// Over the area of all bodies, a third of each triangle at each of its vertices.
double Controller::meanSquare(const Vector& displacement, size_t body) const {
  const Body& in = model_.bodies[body];
  const size_t points = in.weights().size() / in.mesh().triangles.size();
  double sum = 0;
  for (size_t i = 0; i < in.weights().size(); ++i)
    for (const int vertex : in.mesh().triangles[i / points])
      sum += in.weights()[i] / 3 / area_ * displacement.segment<2>(2 * vertex).squaredNorm();
  return sum;
}

void Controller::rescale(const State& state) {
  double stress = 0;
  double displacement = 0;
  double strain = 0;
  for (size_t b = 0; b < state.bodies.size(); ++b) {
    const Norms norms = normsOf(state.bodies[b].stress, b);
    stress += norms.energy;
    strain += norms.strain;
    displacement += meanSquare(state.bodies[b].displacement, b);
  }
  ControllerMemory& scales = memory_.controller;
  scales.stress = std::max(scales.stress, std::sqrt(stress));
  // Where everything is held no displacement is a scale: what the elastic strain makes of the extent is.
  scales.displacement = std::max({scales.displacement, std::sqrt(displacement), extent_ * std::sqrt(strain)});
}

double Controller::measured(const std::vector<Response>& error) const {
  double stress = 0;
  double displacement = 0;
  for (size_t b = 0; b < error.size(); ++b) {
    stress += normsOf(error[b].stress, b).energy;
    displacement += meanSquare(error[b].displacement, b);
  }
  const ControllerMemory& scales = memory_.controller;
  const double s = stress > 0 ? std::sqrt(stress) / scales.stress : 0;
  const double u = displacement > 0 ? std::sqrt(displacement) / scales.displacement : 0;
  return std::isfinite(s) && std::isfinite(u) ? std::max(s, u) : 1 / plan_.tolerance;
}

void Controller::pilot(StepTaker& taker, State& state) {
  constexpr double steps = 5;
  constexpr double firstStep = 1.0 / 24;
  memory_.controller.timeStep =
      plan_.steps > 0 ? (plan_.end - state.time) / plan_.steps : firstStep * (plan_.end - state.time);
  const State begin = state;
  bool converged = true;
  rescale(state);
  for (double from = begin.time; converged && from < plan_.end; from = state.time) {
    const double to = stopAfter(from);
    const int parts = static_cast<int>(std::ceil(steps * (to - from) / (plan_.end - begin.time)));
    for (int i = 1; converged && i <= parts; ++i) {
      const StepOutcome outcome =
          taker.attempt(i == parts ? to : from + (to - from) * i / parts, Scheme::backwardEuler);
      converged = outcome.converged;
      memory_.run.iterations += outcome.iterations;
      memory_.run.pilotIterations += outcome.iterations;
      memory_.run.factorisations += outcome.factorisations;
      if (!converged) break;
      taker.commit();
      rescale(state);
    }
  }
  state = begin;
  memory_.increments.clear();
}

void Controller::advance(StepTaker& taker, const State& state, StepReport& report) {
  constexpr int patience = 12;      // attempts in a row that cannot be solved
  constexpr double smallest = 0.1;  // of a step that still changes the time
  int failures = 0;
  double& proposal = memory_.controller.timeStep;
  const auto giveUp = [&](Status status, double t1, const std::string& why) {
    std::ostringstream reason;
    reason << "step " << report.step << " at t = " << t1 << " s: " << why;
    report.status = status;
    report.reason = reason.str();
  };
  while (true) {
    const double t1 = nextTime(state.time);
    const double k = t1 - state.time;
    if (memory_.run.steps + memory_.run.rejected + report.rejections >= plan_.maxSteps)
      return giveUp(Status::failed, t1, "all of max_steps = " + std::to_string(plan_.maxSteps) + " are used");
    const StepOutcome outcome = taker.attempt(t1);
    report.iterations += outcome.iterations;
    report.factorisations += outcome.factorisations;
    if (!outcome.converged) {
      report.rung = "cut";
      ++report.rejections;
      // The end of equilibrium is approached as closely as the tolerance asks.
      if (outcome.unheld && k <= plan_.tolerance * (plan_.end - memory_.begin))
        return giveUp(Status::unheld, t1, outcome.reason);
      if (++failures == patience)
        return giveUp(outcome.unheld ? Status::unheld : Status::failed, t1, outcome.reason);
      proposal = failureFactor * k;
      continue;
    }
    failures = 0;
    // Errors of the first order add up over as many steps as it takes: they are judged by their share of the
    // time.
    const bool summed = plan_.scheme == Scheme::backwardEuler;
    const double error =
        measured(taker.error(t1 < stopAfter(state.time))) * (summed ? (plan_.end - memory_.begin) / k : 1);
    const double factor =
        std::clamp(safety * std::pow(error / plan_.tolerance, -1.0 / (taker.errorOrder() - (summed ? 1 : 0))),
                   leastFactor, largestFactor);
    if (error > plan_.tolerance) {
      ++report.rejections;
      proposal = factor * k;
      if (!(state.time + smallest * proposal > state.time))
        return giveUp(Status::failed, t1, "no step is small enough for the tolerance");
      continue;
    }
    // A step that was only shortened to end on a stop tells nothing against a longer one.
    const bool shortened = k < proposal && factor >= 1;
    const double grown = (report.rejections > 0 ? std::min(factor, 1.0) : factor) * k;
    proposal = shortened ? std::max(grown, proposal) : grown;
    taker.commit();
    rescale(state);
    report.time = t1;
    report.timeStep = k;
    report.estimate = error;
    report.guarded = taker.guarded();
    report.certificate = outcome.certificate;
    if (outcome.rung != "newton" && report.rung == "newton") report.rung = outcome.rung;
    return;
  }
}

}  // namespace mortier
