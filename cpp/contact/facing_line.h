// The pairing of a part of the nonmortar line with the mortar line. A point x1(s) of the part faces the
// point x2 of the mortar line in the contact direction n,
//
//   (x1(s) - x2) x n = 0,      n ~ R1 n1(s) - R2 n2(x2),
//
// n1, n2 the outward normals of both bodies and R1, R2 the radii of curvature of the lines there. Where a
// curve meets a straight line, n is the normal of the straight line; where two curves meet, n is the normal
// of the tangent plane of Hertz's theory, to second order in the width of contact over the radius. It does
// not depend on which side is nonmortar. A straight part has n = n1. At a corner of the mortar line, whose
// radius is 0, n = n1 too.
//
// The abscissae s of the mortar nodes make the common refinement of two curves that of two traces
// (segments.h). Past the ends of the part the first and last element go on straight with the normal of the
// end.
#pragma once

#include <array>
#include <functional>
#include <vector>

#include "contact/element_tree.h"
#include "contact/smooth_part.h"

namespace mortier {

/// Geometry of an element of the mortar line, at its two ends.
struct FacingElement {
  std::array<Point, 2> normals;                       ///< outward of the mortar body
  std::array<double, 2> curvatures{};                 ///< without sign [1/m]
  std::array<double, 2> smooth{1, 1};                 ///< 0 at a corner
  Arc arc;                                            ///< as the mortar body runs
  std::shared_ptr<const SmoothPart> drawn = nullptr;  ///< of its part, if that has moved
  int inPart = 0;                                     ///< the element there
};

/// The mortar line, against the direction of its body, with the normals and curvatures of its smooth parts.
struct MortarLine : ElementLine {
  explicit MortarLine(const BoundaryLine& boundary) : MortarLine(smoothParts(boundary), boundary.closed) {}
  MortarLine(const std::vector<SmoothPart>& parts, bool closed);

  std::vector<FacingElement> geometry;  ///< by elements
  bool closed = false;
  ElementTree tree;
};

/// The stretch of it that faces a part: abscissae are those of the part. A node may come twice.
struct FacingLine : ElementLine {
  std::vector<FacingElement> geometry;

  [[nodiscard]] bool empty() const { return nodes.size() < 2; }
};

/// The stretch of the mortar line that faces the part: the abscissae ascend and the normals make an angle of
/// 120 degrees at least. Of several the nearest one. It ends with the first node beyond the part. Empty when
/// nothing faces it.
FacingLine facingLine(const SmoothPart& part, const MortarLine& mortar);

/// x1(s) and the point that it faces, and the direction of the line through both, so that opposite forces
/// along it have no moment.
struct FacingPair {
  EdgeValues phi;       ///< shape functions of the nonmortar element at x1
  EdgeValues psi;       ///< of the mortar element at x2; linear in s where the part is straight
  Point normal;         ///< direction n, of length one
  double stretch = 1;   ///< length of the element by its abscissa; not 1 where it is bent
  double distance = 0;  ///< of the two lines along n [m]
  double bulge = 0;     ///< what the curves that the elements stand for (arcs.h) take from it [m]
};

/// Distance g0 of the bodies at a place of a nonmortar element [m].
using DistanceAt = std::function<double(int element, double s, const FacingPair& facing)>;

/// As meshed, of the curves that the lines stand for.
inline double distanceOfCurves(int /*element*/, double /*s*/, const FacingPair& facing) {
  return facing.distance - facing.bulge;
}

FacingPair facingPair(const SmoothPart& part, const FacingLine& mortar, const Segment& segment, double s);

/// A node of the part (`ElementLine::nodesOf`) with the point that it faces, and their elements.
struct FacingNode {
  FacingPair facing;
  Segment place;
};

FacingNode facingOfNode(const SmoothPart& part, const FacingLine& mortar, int node);

/// The direction of contact at a node of the part; its normal where it faces nothing.
Point directionAt(const SmoothPart& part, const FacingLine& mortar, int node);

}  // namespace mortier
