// The curve that a polygonal line stands for. A polygon of edges of length h in a circle of radius R is off
// it by the sagitta h^2/(8 R) between its nodes; where two such lines are as close as that, their distance as
// meshed is noise.
//
// Elements whose nodes lie with their neighbours on one circle, or on one straight line, to 1e-6 of the
// length of that run (or of the radius) stand for its arc. A run has four nodes at least: three lie on a
// circle always. Where the mesh tells a third point of the curve behind another element, that stands for the
// arc through the three. Where the mesh has the curve itself (Gmsh's that are no circles), the element stands
// for that. The curve behind the rest is not known.
#pragma once

#include <vector>

#include "base/types.h"
#include "mesh/sampled_curve.h"

namespace mortier {

struct Arc {
  double curvature =
      0;               ///< [1/m], positive where the line turns to the left: the body, on its left, is convex
  bool known = false;  ///< otherwise the curvature is an estimate
  EdgeCurve curve = {};  ///< in place of the arc, where it is known
};

/// Of the circles through the nodes and their two neighbours, signed; at the ends of an open line that of the
/// neighbour.
std::vector<double> nodalCurvatures(const std::vector<Point>& points, bool closed);

/// One for each element; `middles` are points of the curves behind them,
/// not finite or empty where these are not known.
/// \pre the first and the last point of a closed line agree
std::vector<Arc> arcsOf(const std::vector<Point>& points, bool closed,
                        const std::vector<Point>& middles = {});

/// By how much a polygon turns at its sharpest node where a circle goes through five of its vertices in turn
/// and the turn is above a least one, else 0 [rad]: an octagon has pi/4.
/// \pre the first and the last point of a closed line agree
double turnOfPolygon(const std::vector<Point>& points, bool closed, double least);

/// How far what stands behind the element from a to b is from the point x, as below; 0 where it is straight
/// or not known [m].
double distanceTo(const Arc& arc, const Point& a, const Point& b, const Point& x, const Point& n);

/// How far the arc from a to b is from the point x, on its chord or near it, along the direction n of length
/// one (outward, to the right of a to b, or not far from that) [m].
double distanceToArc(const Point& a, const Point& b, double curvature, const Point& x, const Point& n);

/// Of the arc over an element of this length [m].
inline double sagitta(double length, double curvature) {
  return length * length * (curvature < 0 ? -curvature : curvature) / 8;
}

}  // namespace mortier
