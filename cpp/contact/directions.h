// The direction of contact at the vertices of a part of the nonmortar line. Between them it is interpolated.
//
// Smooth lines. At a vertex x1 that faces x2,
//
//   n = (1 - w) n1 - w n2,   made a unit vector,
//
// n1, n2 the outward normals of both bodies. By default w = k1 / (k1 + k2), k the curvatures: where a curve
// meets a straight line n is the normal of the straight line, where two curves meet it is that of the tangent
// plane of Hertz's theory, and it does not depend on which side is nonmortar. A straight part has w = 0.
// Where rows follow the bodies w is given: contact acts along the normal of the stiffer body, which hardly
// bends.
//
// Corners and ends of lines have no normal. Two smooth lines touch where their normals are opposite; where
// the distance falls all the way to an end of one line, contact is at that end, along the normal of the other
// line:
//
//   the distance falls to an end of the part        w = 1   (the normal of the mortar line)
//   it falls to a corner or an end of the mortar line   w = 0   (that of the part)
//
// at all vertices on the way there. Slopes of the distance between half a degree and one degree blend both
// rules, so that the direction is a continuous function of the places. Towards a corner of the mortar line w
// falls to 0 within the length of a nonmortar element, so that a vertex passes it smoothly. Mean values over
// row functions would miss a sharp corner (slopes of 0.1 to 0.15 and more) until an element has sunk in:
// there is one condition at the place itself (CornerContact).
#pragma once

#include <optional>
#include <vector>

#include "contact/mortar_line.h"

namespace mortier {

/// A corner or an end of one line, from which the distance rises to all sides, and what it faces.
struct CornerContact {
  int vertex = 0;       ///< of the part: the corner itself, or the nearest one to that of the mortar line
  int nonmortar = 0;    ///< element of the part
  double s = 0;         ///< abscissa on it [m]
  int mortar = 0;       ///< element of the mortar line
  double weight = 0;    ///< from 0 where the distance rises little to 1
  bool ofPart = false;  ///< whether it is an end of the part
  int node = -1;        ///< else that of the mortar line
};

struct ContactDirections {
  std::vector<Point> n;                ///< by vertices of the part, of length one; n1 where they face nothing
  std::vector<CornerContact> corners;  ///< one a vertex at most
  std::vector<double> mortarShare;     ///< w, by vertices
};

/// The direction at a part xi of an element, not of length one.
inline Point between(const std::vector<Point>& n, int element, double xi) {
  return (1 - xi) * n[element] + xi * n[element + 1];
}

/// \param mortarShare  w; by the curvatures where it is not given
/// \param kept  directions found before, of which w and the weights and vertices of corners are kept: where a
/// vertex passes a corner they change by steps
ContactDirections contactDirections(const SmoothPart& part, const MortarLine& mortar,
                                    std::optional<double> mortarShare = std::nullopt,
                                    const ContactDirections* kept = nullptr);

}  // namespace mortier
