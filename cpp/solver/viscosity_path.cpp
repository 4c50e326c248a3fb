#include "solver/viscosity_path.h"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <utility>

namespace mortier {
namespace {

constexpr double firstStiffness = 0.3;
constexpr double roughly = 1e-5;  // material residual of a place on the way
constexpr int correctorIterations = 5;
constexpr int lastIterations = 20;
constexpr double lost = 100;      // beyond this many yield stresses the corrector does not come back
constexpr double tiniest = 1e-9;  // length of a step

}  // namespace

ViscosityPath::ViscosityPath(StepSolver& solver, const State& state0, const StepData& step)
    : solver_(solver), state0_(state0), step_(step), eased_(step), loads_(solver.loadsAt(step.time)) {
  double largest = 0;
  for (const Body& body : solver.model_.bodies) {
    unit_.push_back(body.material().stressScale());
    largest = std::max(largest, unit_.back());
    stiffness_ = std::max(stiffness_, body.material().stiffness(step.weight));
  }
  for (double& unit : unit_)
    if (unit == 0) unit = largest;
}

double ViscosityPath::dot(const std::vector<Response>& a, const std::vector<Response>& b) const {
  double sum = 0;
  for (size_t i = 0; i < a.size(); ++i)
    sum += a[i].stress.cwiseProduct(b[i].stress).sum() / (unit_[i] * unit_[i]);
  return sum;
}

void ViscosityPath::move(const Direction& along, double length, Place& place) {
  place.decades += length * along.decades;
  for (size_t b = 0; b < along.response.size(); ++b) {
    const auto& [displacement, stress] = along.response[b];
    BodyIterate& body = place.iterate.bodies[b];
    body.stress += length * stress;
    body.increment += length * displacement;
  }
}

ViscosityPath::Direction ViscosityPath::difference(const Place& a, const Place& b) {
  Direction result;
  result.decades = a.decades - b.decades;
  for (size_t i = 0; i < a.iterate.bodies.size(); ++i)
    result.response.push_back({{}, a.iterate.bodies[i].stress - b.iterate.bodies[i].stress});
  return result;
}

void ViscosityPath::linearise(Place& place) {
  eased_.weight = step_.weight * std::pow(10, place.decades);
  residual_ = solver_.linearise(state0_, eased_, place.iterate, true);
}

ViscosityPath::Direction ViscosityPath::directionAt(const Place& place) {
  std::vector<Matrix> flow;
  for (size_t b = 0; b < place.iterate.bodies.size(); ++b) {
    Matrix rate;
    solver_.model_.bodies[b].material().viscoplasticRate(place.iterate.bodies[b].stress, rate);
    flow.push_back(std::numbers::ln10 * eased_.weight * rate);
  }
  Direction result{solver_.respond(flow, place.iterate.active), 1};
  const double length =
      startSign_ * solver_.determinantSign(place.iterate.active) * std::sqrt(dot(result, result));
  result.decades /= length;
  for (auto& [displacement, stress] : result.response) {
    displacement /= length;
    stress /= length;
  }
  return result;
}

ViscosityPath::Correction ViscosityPath::correct(const Direction& along, Place& place) {
  const Place predicted = place;
  Correction result;
  for (;; ++result.iterations) {
    linearise(place);
    result.converged = result.iterations > 0 && residual_ <= roughly;
    if (result.converged || result.iterations == correctorIterations || !std::isfinite(residual_) ||
        (result.iterations >= 2 && residual_ > lost))
      return result;
    ++total_.iterations;
    if (!solver_.factorise(total_)) return result;
    Place before = place;
    solver_.solveLinearised(state0_, loads_, place.iterate, total_);
    if (!total_.reason.empty()) return result;
    before.iterate.active = place.iterate.active;
    result.direction = directionAt(before);
    // Back into the plane across `along`, no more than a decade at once.
    const double size = -dot(along, difference(place, predicted)) / dot(along, result.direction);
    const double farthest = 1 / std::abs(result.direction.decades);
    move(result.direction, std::clamp(size, -farthest, farthest), place);
    if (dot(along, result.direction) < 0) {
      result.beyond = result.direction;
      result.found = true;
    }
  }
}

StepOutcome ViscosityPath::finish(int maxIterations, const Direction& along, Iterate& solution) {
  Place end = at_;
  move(along, -at_.decades / along.decades, end);
  const int iterations = std::min(lastIterations, maxIterations - total_.iterations);
  StepOutcome last =
      solver_.newton(state0_, step_, {iterations, solver_.options_.tolerance, true}, end.iterate);
  last.iterations += total_.iterations;
  last.factorisations += total_.factorisations;
  if (last.converged) solution = std::move(end.iterate);
  return last;
}

StepOutcome ViscosityPath::follow(int maxIterations, Iterate& solution) {
  constexpr double longest = 20;
  constexpr double sharp = 0.03;  // corners are looked for in steps no longer than this

  at_.iterate = solver_.start(state0_);
  at_.decades = std::min(0.0, std::log10(firstStiffness / stiffness_));
  eased_.weight = step_.weight * std::pow(10, at_.decades);
  total_ = solver_.newton(state0_, eased_, {lastIterations, roughly, true}, at_.iterate);
  if (!total_.converged) return total_;
  total_.converged = false;
  linearise(at_);
  ++total_.iterations;
  if (!solver_.factorise(total_)) return total_;
  startSign_ = solver_.determinantSign(at_.iterate.active);
  constexpr double leap =
      1e-4;  // of a step this short it does not matter if it leaves a loop of the curve out
  Direction along = directionAt(at_);
  double length = 0.5;
  bool corner = false;
  Direction beyond;
  while (total_.iterations < maxIterations && length > tiniest) {
    total_.reason.clear();
    total_.unheld = false;
    const Direction& ahead = corner ? beyond : along;
    if (at_.decades + length * ahead.decades >= 0) {
      StepOutcome last = finish(maxIterations, ahead, solution);
      if (last.converged) return last;
      total_.iterations = last.iterations;
      total_.factorisations = last.factorisations;
      length = -at_.decades / ahead.decades / 3;
      corner = false;
      continue;
    }
    Place place = at_;
    move(ahead, length, place);
    Correction correction = correct(ahead, place);
    bool good = correction.converged;
    if (good) {
      // Whether the curve leads on from here. What the corrector knows of it may be of an iterate before.
      const Direction gone = difference(place, at_);
      if (dot(correction.direction, gone) < 0 && (corner || length > leap)) {
        ++total_.iterations;
        good = solver_.factorise(total_);
        if (good) correction.direction = directionAt(place);
        good = good && dot(correction.direction, gone) >= 0;
      }
    }
    if (!good) {
      const bool tried = std::exchange(corner, false);
      if (!tried && correction.found && !correction.converged && length < sharp) {
        corner = true;
        beyond = std::move(correction.beyond);
        length *= 2;
      } else {
        length /= tried ? 6 : 3;
      }
      continue;
    }
    if ((along.decades > 0) != (correction.direction.decades > 0)) turns_.push_back(-at_.decades);
    at_ = std::move(place);
    along = std::move(correction.direction);
    corner = false;
    if (correction.iterations <= 2) length *= 2;
    if (correction.iterations == 3) length *= 1.4;
    length = std::min(length, longest);
  }
  total_.unheld = false;
  if (total_.reason.empty()) total_.reason = "the path of viscosities was not followed to its end";
  return total_;
}

}  // namespace mortier
