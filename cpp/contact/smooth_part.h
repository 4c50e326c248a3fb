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

#include <array>
#include <cmath>
#include <memory>
#include <vector>

#include "base/types.h"
#include "mesh/boundary_line.h"
#include "mesh/element_nodes.h"
#include "mesh/triangle_mesh.h"

namespace mortier {

// The curve that a polygonal line stands for. A polygon of edges of length h in a circle of radius R is off
// it by the sagitta h^2/(8 R) between its nodes; where two such lines are as close as that, their distance as
// meshed is noise.
//
// Elements whose nodes lie with their neighbours on one circle, or on one straight line, to 1e-6 of the
// length of that run (or of the radius) stand for its arc. A run has four nodes at least: three lie on a
// circle always. Where the mesh has a third point of the curve behind another element, that stands for the
// arc through the three. Where the mesh has the curve itself (Gmsh's that are no circles), the element stands
// for that. The curve behind the rest is not known.

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

// A line of elements in contact: places, abscissae, and the displacement trace on it.
//
// An element runs between two vertices. Its trace is linear, or quadratic with a node in the middle: then the
// element is straight, or bent through the place of that node (isoparametric), and its abscissa runs with the
// parameter. Nodes are counted along the line, the vertices first, then the middles.

/// Abscissae along Gamma_C, strictly ascending [m].
using Trace = std::vector<double>;

struct ElementLine {
  std::vector<int> nodes;     ///< vertex numbers along the line; first and last agree where it is closed
  std::vector<Point> points;  ///< [m]
  std::vector<int> middles;   ///< node numbers, one an element; empty where the trace is linear
  std::vector<Point> middlePoints;  ///< their places; those of straight elements halfway [m]
  Trace s;                          ///< abscissae of the vertices, strictly ascending [m]

  [[nodiscard]] int elements() const { return static_cast<int>(nodes.size()) - 1; }
  [[nodiscard]] int degree() const { return middles.empty() ? 1 : 2; }
  [[nodiscard]] int traceNodes() const { return static_cast<int>(nodes.size() + middles.size()); }
  /// The number in its mesh of a node of the line.
  [[nodiscard]] int number(int node) const {
    const auto vertices = static_cast<int>(nodes.size());
    return node < vertices ? nodes[node] : middles[node - vertices];
  }
  [[nodiscard]] EdgeNodes nodesOf(int element) const {
    if (middles.empty()) return EdgeNodes{{element, element + 1}};
    return EdgeNodes{{element, element + 1, static_cast<int>(nodes.size()) + element}};
  }
  /// Part of the element at an abscissa.
  [[nodiscard]] double partAt(int element, double abscissa) const {
    return (abscissa - s[element]) / (s[element + 1] - s[element]);
  }
  [[nodiscard]] bool bent(int element) const {
    return !middles.empty() && middlePoints[element] != (points[element] + points[element + 1]) / 2;
  }
  /// The place at a part xi of an element.
  [[nodiscard]] Point at(int element, double xi) const {
    const Point chord = (1 - xi) * points[element] + xi * points[element + 1];
    return bent(element) ? Point(chord + 4 * xi * (1 - xi) * bow(element)) : chord;
  }
  /// dx/dxi
  [[nodiscard]] Point tangentAt(int element, double xi) const {
    const Point chord = points[element + 1] - points[element];
    return bent(element) ? Point(chord + 4 * (1 - 2 * xi) * bow(element)) : chord;
  }

 private:
  [[nodiscard]] Point bow(int element) const {
    return middlePoints[element] - (points[element] + points[element + 1]) / 2;
  }
};

/// A line that turns by more than that at a node has a corner there [rad].
constexpr double sharpTurn =
    (1 + 1e-9) * M_PI * 2 / 9;  // a nonagon is a circle, whatever rounding makes of it

struct SmoothPart : ElementLine {  ///< abscissae: arc length from the first vertex
  std::vector<Point> normals;      ///< at the vertices, outward, of length one
  std::vector<double> curvatures;  ///< at the vertices, without sign [1/m]; 0 where the part is straight
  std::vector<Arc> arcs;           ///< what the elements stand for
  bool straight = false;
  bool closed = false;
  std::array<bool, 2> corners{};                      ///< whether another part of the line begins at its ends
  std::shared_ptr<const SmoothPart> drawn = nullptr;  ///< where this one has moved: as it was meshed

  [[nodiscard]] double length() const { return s.back(); }
  /// Direction of an element, of length one.
  [[nodiscard]] Point direction(int element) const;
};

/// What else is a corner: every node between elements that are known to be straight, however little the line
/// turns there. Of a mortar line it is; a nonmortar node would get two conditions of nearly one direction.
enum class Kinks { none, ofStraightElements };

/// The parts in their order. A closed line without a corner is one closed part.
std::vector<SmoothPart> smoothParts(const BoundaryLine& line, Kinks kinks = Kinks::none);

/// The part where displacements (by dofs of its mesh) have moved it, as a curve; its curvatures, and what its
/// elements stand for, are those of the drawn one.
SmoothPart moved(const std::shared_ptr<const SmoothPart>& drawn, const Vector& u);

/// The same closed line begun at another of its nodes (an index of `line.nodes`).
BoundaryLine begunAt(const BoundaryLine& line, int first);

}  // namespace mortier
