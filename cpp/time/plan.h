// When a march makes its steps.
#pragma once

#include <vector>

#include "time/breaks.h"
#include "time/quantity.h"
#include "time/scheme.h"

namespace mortier {

struct TimePlan {
  double end = 1;  ///< T [s]
  int steps = 1;   ///< N equal steps; with a tolerance the first step tried is T/N, 0: chosen
  Scheme scheme = Scheme::backwardEuler;
  double tolerance = 0;   ///< relative error of every step of the run; 0: equal steps
  int maxSteps = 100000;  ///< attempts before the run is given up; with a tolerance
  /// Times of kinks and jumps of the data, ascending [s]; steps chosen by their error end there.
  std::vector<double> breaks = {};
  /// Data in time: no step chosen by its error jumps over a part of one.
  std::vector<Course> data = {};
  std::vector<Quantity> quantities = {};  ///< that are evaluated at the end of every step
  /// By interfaces, whether a node may slide past the end of the line that it touches; others may.
  std::vector<bool> slidingAllowed = {};
  /// Whether an overlap of bodies that nothing explains ends the run; else it is only reported.
  bool overlapEnds = true;
  double begin = 0;  ///< 0, or the end of the run from which this one goes on [s]

  [[nodiscard]] double duration() const { return end - begin; }
  /// Length of an equal step [s].
  [[nodiscard]] double step() const { return duration() / steps; }
  /// Whether steps are chosen by their error; otherwise they are equal.
  [[nodiscard]] bool controlled() const { return tolerance > 0; }
};

}  // namespace mortier
