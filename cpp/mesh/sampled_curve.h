// A curve by points of it. x(t), 0 <= t <= 1, is piece by piece the polynomial of degree 8 through nine
// points of the curve, at Chebyshev's places with both ends (barycentric formula; Berrut, Trefethen 2004).
// Pieces are halved until they are the curve to a tolerance, so that a jump of a curvature, or a kink, lies
// in a piece that is small enough.
#pragma once

#include <functional>
#include <memory>
#include <vector>

#include "base/types.h"

namespace mortier {

struct SampledCurve {
  std::vector<double> knots;  ///< t at the ends of the pieces, from 0 to 1
  std::vector<Point> points;  ///< eight a piece, and the last one [m]

  [[nodiscard]] Point at(double t) const;
};

/// Empty where thousands of pieces are not the curve.
/// \param points  of the curve at places t in [0, 1] [m]
/// \param tolerance  of the distance between x(t) and the curve's point at t [m]
SampledCurve sampled(const std::function<std::vector<Point>(const std::vector<double>&)>& points,
                     double tolerance);

/// The stretch of a curve that an edge stands for, from its first vertex to its second.
struct EdgeCurve {
  std::shared_ptr<const SampledCurve> curve = nullptr;  ///< none where it is not known
  double from = 0;                                      ///< t at the first vertex, may be the larger one
  double to = 1;

  [[nodiscard]] bool known() const { return curve != nullptr; }
  [[nodiscard]] Point at(double t) const { return curve->at(t); }
  /// t where the stretch meets the straight line through x along n; at the end next to that line where it
  /// does not. \pre known
  [[nodiscard]] double meeting(const Point& x, const Point& n) const;
  /// t where it is equally far from both its ends. \pre known
  [[nodiscard]] double middle() const;
};

}  // namespace mortier
