// Data in time are sampled before a run, to find their kinks and jumps, where steps chosen by their error
// end, and to recognise a step that would skip a part of a datum.
#pragma once

#include <functional>
#include <vector>

namespace mortier {

/// A datum in time as it was found. Between neighbouring samples it is smooth, if it could be resolved.
struct Course {
  std::function<double(double)> value;
  std::vector<double> times;   ///< of the samples, ascending [s]
  std::vector<double> values;  ///< there
  std::vector<double>
      breaks;        ///< of kinks and jumps inside, ascending [s]; of a jump the numbers on both its sides
  double range = 0;  ///< largest less smallest value
  bool resolved = true;  ///< false: it varies faster than can be sampled
};

/// An interval is smooth where a cubic through four of its points meets others; what is not is halved, down
/// to 1e-7 of the whole, and the number with the fewest digits taken for a kink. The first intervals are
/// 1/499 of the whole: a pulse shorter than 1/3000 of it may be missed, or with `fine` further samples at
/// equal distances one shorter than such a distance.
Course resolve(std::function<double(double)> datum, double begin, double end, int fine = 0);

/// A datum that is linear between the times of a table and constant outside.
Course tableCourse(std::function<double(double)> datum, const std::vector<double>& times, double begin,
                   double end);

/// By how much the datum is missed by the polynomial through its values at the start of the step [t0, t1] and
/// at the fractions `nodes` of it, over the range of the datum: at most at the samples inside.
double unseen(const Course& course, const std::vector<double>& nodes, double t0, double t1);

/// Where a datum goes farthest beyond its values at t0 and t1 in between.
struct CoursePeak {
  double time = 0;    ///< [s]; of the sample
  double height = 0;  ///< over the range of the datum; 0: nowhere
};
CoursePeak peakBetween(const Course& course, double t0, double t1);

}  // namespace mortier
