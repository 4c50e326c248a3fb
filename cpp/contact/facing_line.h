// The mortar line as a part of the nonmortar line sees it along its normals: each mortar node gets the
// abscissa s of the point x1(s) from which it lies in the direction of the normal,
//
//   (x1(s) - x2) x n(s) = 0,
//
// a quadratic equation on each element of a curve, a scalar product on a straight part. Past the ends of the
// part the first and last element go on straight with the normal of the end. With these abscissae the common
// refinement of two curves is that of two traces (segments.h).
#pragma once

#include <vector>

#include "contact/smooth_part.h"

namespace mortier {

struct FacingLine {
  std::vector<int> nodes;     ///< vertex numbers, in the direction of the part; a node may come twice
  std::vector<Point> points;  ///< [m]
  Trace s;                    ///< abscissae on the part, strictly ascending [m]

  [[nodiscard]] bool empty() const { return nodes.size() < 2; }
};

/// The stretch of the mortar line (as its mesh runs) that faces the part: the abscissae ascend and the
/// normals make an angle of 120 degrees at least. Of several the nearest one. Empty when nothing faces it.
FacingLine facingLine(const SmoothPart& part, const BoundaryLine& mortar);

/// Values of the two hat functions of a mortar element at the point that x1(s) sees along the normal: linear
/// in s where the part is straight. They reproduce that point, so that a pair of opposite forces along the
/// normal has no moment.
Eigen::Vector2d mortarHats(const SmoothPart& part, const FacingLine& mortar, const Segment& segment,
                           double s);

}  // namespace mortier
