#include "time/step_ends.h"

#include <algorithm>
#include <cmath>

namespace mortier {

StepEnds::StepEnds(const TimePlan& plan, double begin) : data_(plan.data) {
  for (const double t : plan.breaks)
    if (t > begin && t < plan.end) breaks_.push_back(t);
  breaks_.push_back(plan.end);
  for (const Stage& stage : tableau(plan.scheme).stages) nodes_.push_back(stage.time);
}

double StepEnds::breakAfter(double t) const {
  return *std::upper_bound(breaks_.begin(), breaks_.end() - 1, t);
}

bool StepEnds::isBreak(double t) const {
  return std::binary_search(breaks_.begin(), breaks_.end(), t);
}

/// The first peak of the data in the step, where contact may close and open again, and bodies yield and
/// unload before the first stage; t1 where there is none, or where waves that move peak all the time
/// somewhere.
/// \param least  height of the peaks that count
double StepEnds::firstPeak(double t0, double t1, double least) const {
  constexpr double apart = 0.1;  // of the step
  constexpr int few = 2;
  std::vector<double> times;
  for (const Course& course : data_)
    if (const CoursePeak peak = peakBetween(course, t0, t1); peak.height > least) times.push_back(peak.time);
  if (times.empty()) return t1;
  std::sort(times.begin(), times.end());
  int distinct = 1;
  for (size_t i = 1; i < times.size(); ++i) distinct += times[i] - times[i - 1] > apart * (t1 - t0) ? 1 : 0;
  return distinct <= few ? times.front() : t1;
}

/// To the next break or peak in one step if it is near, to a break in two if it is not far.
double StepEnds::next(double t, double k, double most) const {
  constexpr double stretch = 1.1;
  constexpr double shorter = 0.8;
  constexpr double leastFactor = 0.2;
  const double end = breakAfter(t);
  while (true) {
    const double t1 = end - t <= stretch * k ? end : end - t <= 2 * k ? t + (end - t) / 2 : t + k;
    double missed = 0;
    for (const Course& course : data_) missed = std::max(missed, unseen(course, nodes_, t, t1));
    // A parabola that a step misses by so much rises above its ends by the square.
    if (missed <= most || !(t + shorter * k > t)) return firstPeak(t, t1, most * most);
    const double order = static_cast<double>(nodes_.size()) + 1;
    k = std::min(k, t1 - t) * std::clamp(std::pow(missed / most, -1 / order), leastFactor, shorter);
  }
}

}  // namespace mortier
