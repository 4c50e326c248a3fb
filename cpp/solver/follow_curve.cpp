#include <algorithm>
#include <cmath>
#include <numbers>

#include "base/digits.h"
#include "solver/methods.h"

namespace mortier {
namespace {

using Place = ViscosityContinuation::Place;

constexpr double roughly = 1e-5;  // material residual of a place on the way
constexpr int lastIterations = 20;

/// A direction of the curve, of length one: stresses over the yield stress, and decades.
struct Direction {
  std::vector<Response> response;
  double decades = 0;
};

void move(const Direction& along, double length, Place& place) {
  place.decades += length * along.decades;
  for (size_t b = 0; b < along.response.size(); ++b) {
    const auto& [displacement, stress] = along.response[b];
    place.iterate.bodies[b].stress += length * stress;
    place.iterate.bodies[b].increment += length * displacement;
  }
}

Direction difference(const Place& a, const Place& b) {
  Direction result;
  result.decades = a.decades - b.decades;
  for (size_t i = 0; i < a.iterate.bodies.size(); ++i)
    result.response.push_back({{}, a.iterate.bodies[i].stress - b.iterate.bodies[i].stress});
  return result;
}

/// The curve of a step, and the work done along it.
class Curve {
 public:
  Curve(StepSystem& system, const Step& step) : system_(system), step_(step) {
    double largest = 0;
    for (const Body& body : system.model().bodies) {
      unit_.push_back(body.material().stressScale());
      largest = std::max(largest, unit_.back());
    }
    for (double& unit : unit_)
      if (unit == 0) unit = largest;
  }

  [[nodiscard]] double weightAt(const Place& place) const {
    return step_.data.weight * std::pow(10, place.decades);
  }

  /// Linear solves at the viscosity of the place until its residual is `tolerance`.
  bool solve(double tolerance, int iterations, Place& place) {
    total.follow(newton(system_, step_, weightAt(place), {iterations, tolerance, true}, place.iterate));
    return total.converged();
  }

  /// The direction at a place, towards larger `decades`. \returns false where the tangent is singular there.
  bool directionAt(Place& place, Direction& direction) {
    ++total.iterations;
    const auto tangent = system_.linearise(step_, place.iterate, weightAt(place), true).factorise(total);
    if (tangent) direction = directionWith(*tangent, place, {{}, 1});
    return tangent.has_value();
  }

  struct Correction {
    bool converged = false;
    int iterations = 0;
    Direction direction;  ///< of the curve, as of the last linear solve
  };
  /// Back to the curve in the plane across `along`.
  Correction correct(const Direction& along, Place& place) {
    constexpr int most = 5;
    constexpr double lost = 100;  // beyond this many yield stresses the corrector does not come back
    const Place predicted = place;
    Correction result;
    for (;; ++result.iterations) {
      const StepSystem::Linearised linearised =
          system_.linearise(step_, place.iterate, weightAt(place), true);
      const double residual = linearised.residual();
      result.converged = result.iterations > 0 && residual <= roughly;
      if (result.converged || result.iterations == most || !std::isfinite(residual) ||
          (result.iterations >= 2 && residual > lost))
        return result;
      ++total.iterations;
      const std::optional<StepSystem::Factorised> tangent = linearised.factorise(total);
      if (!tangent) return result;
      Place before = place;
      if (!tangent->solve(step_, place.iterate, total)) return result;
      before.iterate.active = place.iterate.active;
      before.iterate.slipping = place.iterate.slipping;
      before.iterate.slipDirections = place.iterate.slipDirections;
      result.direction = directionWith(*tangent, before, along);
      // No more than a decade at once.
      const double size = -dot(along, difference(place, predicted)) / dot(along, result.direction);
      const double farthest = 1 / std::abs(result.direction.decades);
      move(result.direction, std::clamp(size, -farthest, farthest), place);
    }
  }

  StepOutcome total;

 private:
  [[nodiscard]] double dot(const Direction& a, const Direction& b) const {
    double sum = 0;
    for (size_t i = 0; i < std::min(a.response.size(), b.response.size()); ++i)
      sum += a.response[i].stress.cwiseProduct(b.response[i].stress).sum() / (unit_[i] * unit_[i]);
    return a.decades * b.decades + sum;
  }

  /// The direction at a place with this tangent, forwards as `along` is.
  [[nodiscard]] Direction directionWith(const StepSystem::Factorised& tangent, const Place& place,
                                        const Direction& along) const {
    std::vector<Matrix> flow;
    for (size_t b = 0; b < place.iterate.bodies.size(); ++b) {
      const auto& [increment, stress, strain] = place.iterate.bodies[b];
      Matrix whole;
      if (step_.strain0(b) != nullptr) whole = *step_.strain0(b) + strain;
      Matrix rate;
      system_.model().bodies[b].material().viscoplasticRate(stress, rate, &whole);
      flow.push_back(std::numbers::ln10 * weightAt(place) * rate);
    }
    Direction result{tangent.respond({flow}, place.iterate), 1};
    const double length = std::copysign(std::sqrt(dot(result, result)), dot(along, result));
    result.decades /= length;
    for (auto& [displacement, stress] : result.response) {
      displacement /= length;
      stress /= length;
    }
    return result;
  }

  StepSystem& system_;
  const Step& step_;
  std::vector<double> unit_;  ///< of the stresses of each body
};

}  // namespace

StepOutcome followCurve(StepSystem& system, const Step& step, ViscosityContinuation& continuation,
                        int maxIterations, Iterate& solution) {
  constexpr double longest = 20;
  constexpr double tiniest = 1e-9;  // length of a step
  Curve curve(system, step);
  StepOutcome& total = curve.total;
  Place at = continuation.startOfCurve();
  Direction along;
  if (!curve.solve(roughly, lastIterations, at) || !curve.directionAt(at, along)) return total;
  for (double length = 0.5; total.iterations < maxIterations && length > tiniest;) {
    if (at.decades + length * along.decades >= 0) {
      Place end = at;
      move(along, -at.decades / along.decades, end);
      end.decades = 0;
      if (curve.solve(system.options().tolerance, std::min(lastIterations, maxIterations - total.iterations),
                      end)) {
        solution = std::move(end.iterate);
        return total;
      }
      length = -at.decades / along.decades / 3;
      continue;
    }
    Place place = at;
    move(along, length, place);
    Curve::Correction correction = curve.correct(along, place);
    if (!correction.converged) {
      length /= 3;
      continue;
    }
    if ((along.decades > 0) != (correction.direction.decades > 0))
      continuation.turningPoints.push_back(-at.decades);
    at = std::move(place);
    along = std::move(correction.direction);
    if (correction.iterations == 1) length *= 2;
    if (correction.iterations == 2) length *= 1.4;
    length = std::min(length, longest);
  }
  total.fail(Reason::unconverged, "the curve of solutions for all viscosities was not followed to its end");
  return total;
}

// Less than half a decade a stage: longer ones jump off the curve.
ViscosityContinuation::ViscosityContinuation(const Model& model, const Step& step)
    : stepSize(0.4), tolerance(0.3), toleranceAtStart(0.3) {
  constexpr double firstStiffness = 0.3;
  constexpr double firstReduction = 2;
  double stiffness = 0;
  for (const Body& body : model.bodies) {
    stiffness = std::max(stiffness, body.material().stiffness(step.data.weight));
    if (!body.material().linear() && body.material().stressScale() == 0) startReduction = firstReduction;
  }
  places.push_back({-(std::log10(stiffness / firstStiffness) + stepSize), startingIterate(step.state0)});
}

ViscosityContinuation::Place ViscosityContinuation::startOfCurve() const {
  constexpr double careful = 1e-3;
  if (toleranceAtStart <= careful && places.size() > 1) return places.back();
  Place place = places.front();
  place.decades = std::min(0.0, place.decades + stepSize);
  return place;
}

StepOutcome lowerViscosity(StepSystem& system, const Step& step, ViscosityContinuation& continuation,
                           int maxIterations, Iterate& solution) {
  constexpr double closer = 1.5;
  constexpr double finestStep = 0.02;
  constexpr int stageIterations = 4;
  constexpr double finestTolerance = 1e-8;
  constexpr int lastIterations = 20;
  constexpr int stagesBack = 2;

  std::vector<ViscosityContinuation::Place>& places = continuation.places;
  StepOutcome total;
  while (total.iterations < maxIterations) {
    ViscosityContinuation::Place place = places.back();
    place.decades = std::min(0.0, place.decades + continuation.stepSize);
    const bool last = place.decades == 0;
    const int iterations =
        std::min(last ? lastIterations : stageIterations, maxIterations - total.iterations);
    const int before = total.iterations;
    total.follow(newton(system, step, step.data.weight * std::pow(10, place.decades),
                        {iterations, last ? system.options().tolerance : continuation.tolerance, true},
                        place.iterate));
    if (total.converged()) {
      if (last) {
        solution = std::move(place.iterate);
        return total;
      }
      places.push_back(std::move(place));
      if (places.size() > 2 * stagesBack + 1) places.erase(places.begin() + 1);
      continue;
    }
    if (total.iterations == before) ++total.iterations;  // not even begun: that must end as well
    if (places.size() == 1 && continuation.startReduction > 0) {
      places.front().decades -= continuation.startReduction;
      continuation.startReduction *= 2;
      continue;
    }
    continuation.tolerance = std::max(finestTolerance, continuation.tolerance / 10);
    continuation.stepSize = std::max(finestStep, continuation.stepSize / closer);
    for (int i = 0; i < stagesBack && places.size() > 1; ++i) places.pop_back();
    if (places.size() == 1) continuation.toleranceAtStart = continuation.tolerance;
  }
  if (!total.unheld())
    total.fail(Reason::unconverged, "the viscosity could not be lowered to that of the step in " +
                                        counted(total.iterations, "iteration") +
                                        (total.detail.empty() ? "" : ", " + total.detail));
  return total;
}

}  // namespace mortier
