// Where steps chosen by their error end: on the breaks of the data and on their peaks, and nowhere so late
// that a part of the data is missed.
#pragma once

#include <vector>

#include "time/plan.h"

namespace mortier {

class StepEnds {
 public:
  StepEnds(const TimePlan& plan, double begin);

  /// The end of a step of about the length k that begins at t [s].
  /// \param most  the part of a datum's range that a step may miss
  [[nodiscard]] double next(double t, double k, double most) const;
  /// The break after t, or the end of the run.
  [[nodiscard]] double breakAfter(double t) const;
  [[nodiscard]] bool isBreak(double t) const;

 private:
  [[nodiscard]] double firstPeak(double t0, double t1, double least) const;

  const std::vector<Course>& data_;
  std::vector<double> nodes_;   ///< stage times of the scheme
  std::vector<double> breaks_;  ///< and the end
};

}  // namespace mortier
