
#include <algorithm>
#include <cmath>

#include "base/digits.h"
#include "solver/methods.h"

namespace mortier {

// Less than half a decade a stage: longer ones jump off the curve.
ViscosityWalk::ViscosityWalk(const Model& model, const Step& step)
    : pace(0.4), tolerance(0.3), roughest(0.3) {
  constexpr double firstStiffness = 0.3;
  constexpr double firstLower = 2;
  double stiffness = 0;
  for (const Body& body : model.bodies) {
    stiffness = std::max(stiffness, body.material().stiffness(step.data.weight));
    if (!body.material().linear() && body.material().stressScale() == 0) lower = firstLower;
  }
  places.push_back({-(std::log10(stiffness / firstStiffness) + pace), startingIterate(step.state0)});
}

ViscosityWalk::Place ViscosityWalk::startOfCurve() const {
  constexpr double careful = 1e-3;
  if (roughest <= careful && places.size() > 1) return places.back();
  Place place = places.front();
  place.decades = std::min(0.0, place.decades + pace);
  return place;
}

StepOutcome lowerViscosity(StepSystem& system, const Step& step, ViscosityWalk& walk, int maxIterations,
                           Iterate& solution) {
  constexpr double closer = 1.5;
  constexpr double finestPace = 0.02;
  constexpr int stageIterations = 4;
  constexpr double finestTolerance = 1e-8;
  constexpr int lastIterations = 20;
  constexpr int stagesBack = 2;

  std::vector<ViscosityWalk::Place>& places = walk.places;
  StepOutcome total;
  while (total.iterations < maxIterations) {
    ViscosityWalk::Place place = places.back();
    place.decades = std::min(0.0, place.decades + walk.pace);
    const bool last = place.decades == 0;
    const int iterations =
        std::min(last ? lastIterations : stageIterations, maxIterations - total.iterations);
    const int before = total.iterations;
    total.follow(newton(system, step, step.data.weight * std::pow(10, place.decades),
                        {iterations, last ? system.options().tolerance : walk.tolerance, true},
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
    if (places.size() == 1 && walk.lower > 0) {
      places.front().decades -= walk.lower;
      walk.lower *= 2;
      continue;
    }
    walk.tolerance = std::max(finestTolerance, walk.tolerance / 10);
    walk.pace = std::max(finestPace, walk.pace / closer);
    for (int i = 0; i < stagesBack && places.size() > 1; ++i) places.pop_back();
    if (places.size() == 1) walk.roughest = walk.tolerance;
  }
  if (!total.unheld())
    total.fail(Reason::unconverged, "the viscosity could not be lowered to that of the step in " +
                                        counted(total.iterations, "iteration") +
                                        (total.detail.empty() ? "" : ", " + total.detail));
  return total;
}

}  // namespace mortier
