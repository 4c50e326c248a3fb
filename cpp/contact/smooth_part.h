// The nonmortar line cut at its corners, each part with a continuous field of normals.
//
// A part is straight, with the one normal that it has, or it approximates a curve. There the normal at a node
// is perpendicular to the parabola through it and its two neighbours (t1, t2 the directions of the elements
// before and after, of lengths h1, h2):
//
//   t = (h2 t1 + h1 t2) / (h1 + h2),
//
// which is exact on a circle; at an end the neighbour's normal is reflected in that of the element.
// Between nodes the normal is interpolated linearly and made a unit vector.
//
// A node is a corner where the line turns by more than 40 degrees (a polygon of less than nine edges is one,
// and no circle, even where its vertices lie on one), or by more than one degree with a
// curvature (turn over length) more than four times that of both neighbours: a curve that a mesh resolves
// turns about as much at every node, a broken line at few. At a corner two parts meet, and its node gets one
// condition from each, along the normal of each.
#pragma once

#include <cmath>
#include <memory>
#include <vector>

#include "contact/arcs.h"
#include "contact/element_line.h"
#include "mesh/boundary_line.h"

namespace mortier {

/// A line that turns by more than that at a node has a corner there [rad].
constexpr double sharpTurn =
    (1 + 1e-9) * M_PI * 2 / 9;  // a nonagon is a circle, whatever rounding makes of it

struct SmoothPart : ElementLine {  ///< abscissae: arc length from the first vertex
  std::vector<Point> normals;      ///< at the vertices, outward, of length one
  std::vector<double> curvatures;  ///< at the vertices, without sign [1/m]; 0 where the part is straight
  std::vector<Arc> arcs;           ///< what the elements stand for
  bool straight = false;
  bool closed = false;
  std::shared_ptr<const SmoothPart> drawn = nullptr;  ///< where this one has moved: as it was meshed

  [[nodiscard]] double length() const { return s.back(); }
  /// n(s) at an abscissa s [m] on an element, or beyond its ends.
  [[nodiscard]] Point normalAt(int element, double abscissa) const;
  [[nodiscard]] double curvatureAt(int element, double abscissa) const;
  /// Direction of an element, of length one.
  [[nodiscard]] Point direction(int element) const;
};

/// The parts in their order. A closed line without a corner is one closed part.
std::vector<SmoothPart> smoothParts(const BoundaryLine& line);

/// The part where displacements (by dofs of its mesh) have moved it, as a curve; its curvatures, and what its
/// elements stand for, are those of the drawn one.
SmoothPart moved(const std::shared_ptr<const SmoothPart>& drawn, const Vector& u);

/// The same closed line begun at another of its nodes (an index of `line.nodes`).
BoundaryLine begunAt(const BoundaryLine& line, int first);

}  // namespace mortier
