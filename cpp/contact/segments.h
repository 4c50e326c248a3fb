// The common refinement of two traces on the line that they share: between its points both are linear.
#pragma once

#include <vector>

#include "base/types.h"

namespace mortier {

/// Abscissae along Gamma_C, strictly ascending [m].
using Trace = std::vector<double>;

/// A piece of Gamma_C on which both traces are linear.
struct Segment {
  int nonmortar = 0;  ///< element: between trace nodes `nonmortar` and `nonmortar + 1`
  int mortar = 0;
  double begin = 0;  ///< [m]
  double end = 0;    ///< [m]
};

/// Ends of the part where both traces lie; begin >= end when they do not overlap.
struct Overlap {
  double begin = 0;
  double end = 0;
  [[nodiscard]] double length() const { return end - begin; }
};

/// Ends of the two traces that differ by rounding only count as one.
Overlap overlapOf(const Trace& nonmortar, const Trace& mortar);

/// The segments of the overlap, ascending; none where there is no overlap.
std::vector<Segment> commonRefinement(const Trace& nonmortar, const Trace& mortar);

/// Values at s of the two hat functions of an element: 1 - x and x.
inline Eigen::Vector2d hats(const Trace& trace, int element, double s) {
  const double x = (s - trace[element]) / (trace[element + 1] - trace[element]);
  return {1 - x, x};
}

}  // namespace mortier
