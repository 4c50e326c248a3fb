// Meshes by what they are of, in place of a file; the curves of their boundaries are known.
#pragma once

#include <variant>

#include "mesh/generate.h"
#include "mesh/tetrahedron_mesh.h"
#include "mesh/triangle_mesh.h"

namespace mortier {

// Meshes of rigid bodies, which have an outline alone: its edges are as fine as distances and pictures need,
// and the triangles behind them have no node but its corners.

/// A closed line without crossings, the body to its left: edge k runs from point k to the next.
struct Outline {
  std::vector<Point> points;           ///< [m]
  std::vector<int> labels;             ///< by edges
  std::vector<EdgeCurve> curves = {};  ///< by edges, straight where there is none; empty: nothing is known
  std::string name = {};               ///< for messages
  std::map<std::string, int> labelNames = {};
};

/// The name of the label of sides that close the outline of a line and are no part of the body.
inline constexpr const char* sideBehind = "behind";

/// A circle, label 1. Beside the axis of revolution, with its centre on it, the half at x >= 0 and the axis
/// itself, label 2.
Outline discOutline(const Point& centre, double radius, bool axisymmetric);
/// A half plane behind the stretch between two points, to the left of it: label 1, what is behind it 2.
Outline lineOutline(const Point& from, const Point& to);
/// The cubic spline through the points (natural; periodic where the first is the last), label 1; the straight
/// side that closes one that is open, label 2.
Outline splineOutline(const std::vector<Point>& points);

/// Cuts ears off the polygon. \throws InputError where it crosses itself or runs clockwise.
TriangleMesh outlineMesh(const Outline& outline);

struct MeshShape {
  std::variant<Rectangle, Quadrilateral, Annulus, HalfDisc, Outline> of;
  Cut cut = Cut::rising;
};

/// Labels as generate.h says; the edges of circles have their middles on them. \throws InputError
TriangleMesh shapeMesh(const MeshShape& shape);

// Generated meshes of tetrahedra.

struct Cuboid {
  SpacePoint lower{0, 0, 0};  ///< [m]
  SpacePoint upper{1, 1, 1};  ///< [m]
  std::array<int, 3> cells{1, 1, 1};
};

/// Every cell cut into six tetrahedra about a diagonal (Kuhn). Labels: 1 bottom, 2 right, 3 top, 4 left, as
/// of a rectangle in x and z, 5 front, 6 back (the least and the largest y). \throws InputError on empty
/// boxes and cell counts below 1.
TetrahedronMesh cuboidMesh(const Cuboid& cuboid);

/// A ball, or a cylinder along z, or a part of it.
struct RoundBody {
  bool ball = false;
  SpacePoint centre{0, 0, 0};      ///< of the ball, or of the bottom of the cylinder [m]
  double radius = 1;               ///< [m]
  double height = 1;               ///< of a cylinder [m]
  std::array<int, 3> keep{};       ///< by axes: 1 beyond the centre only, -1 before it only, 0 both
  std::array<int, 2> cells{1, 1};  ///< along a radius, and along the height
};

/// The plane sides of a cuboid.
struct BoxSide {
  int axis, end, label;
};
inline constexpr std::array<BoxSide, 6> boxSides{
    {{2, 0, 1}, {0, 1, 2}, {2, 1, 3}, {0, 0, 4}, {1, 0, 5}, {1, 1, 6}}};
inline constexpr int roundLabel = 7;

/// A box of cells whose squares or cubes about the centre become circles or spheres. Labels: those of a
/// cuboid for plane sides, 7 "round" for the round one. \throws InputError unless sizes are positive.
TetrahedronMesh roundMesh(const RoundBody& body);

/// One triangle or tetrahedron with a right angle at a place, label and region 1.
TriangleMesh triangleAt(const Point& place, double size);
TetrahedronMesh tetrahedronAt(const SpacePoint& place, double size);

using SpaceShape = std::variant<Cuboid, RoundBody>;
inline TetrahedronMesh shapeMesh(const SpaceShape& shape) {
  if (const auto* round = std::get_if<RoundBody>(&shape)) return roundMesh(*round);
  return cuboidMesh(std::get<Cuboid>(shape));
}

}  // namespace mortier
