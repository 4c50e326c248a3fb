// Overlaps of bodies by their boundaries alone: where the boundary of one, as moved, lies within another.
// Nothing is known here of which labels are in contact, nor of rows.
//
// Boundaries are closed polygons with their body to the left; a side with a node in its middle is the
// parabola through its nodes, in pieces. A point is in a body where the nearest point of its boundary says
// so: by the side there, or at a corner by whether it is reentrant. Boundaries closer than rounding touch.
#pragma once

#include <array>
#include <vector>

#include "contact/element_tree.h"
#include "mesh/element_nodes.h"
#include "mesh/triangle_mesh.h"

namespace mortier {

/// A side of the boundary of a mesh, labelled or not, the body to its left.
struct OutlineSide {
  std::array<int, 2> nodes{};
  int middle = -1;  ///< the node between them; -1 where displacements are linear
  int label = 0;    ///< 0 where it has none
};

/// The whole boundary of a mesh: closed loops.
struct BodyOutline {
  std::vector<OutlineSide> sides;   ///< loop after loop, each in the order in which it runs
  std::vector<int> previous, next;  ///< of each side, that at its ends
};

BodyOutline outlineOf(const TriangleMesh& mesh, const ElementNodes& nodes);

/// Part of the way along a side with its nodes at these places [m].
Point placeOn(const OutlineSide& side, const std::vector<Point>& places, double part);

/// The same with its nodes at given places.
class MovedOutline {
 public:
  /// \param places  by nodes [m]
  MovedOutline(const BodyOutline& outline, const std::vector<Point>& places);

  /// A straight piece of a side.
  struct Piece {
    int side = -1;            ///< -1: between two loops, no piece of any
    double from = 0, to = 1;  ///< of the side, as parts of it
    int previous = -1, next = -1;
  };
  struct Nearest {
    double distance = 0;  ///< negative inside the body [m]
    int piece = -1;
    double part = 0;  ///< of the side
  };
  [[nodiscard]] Nearest nearest(const Point& x) const;

  [[nodiscard]] const std::vector<Piece>& pieces() const { return pieces_; }
  /// End points of piece k are k and k + 1 [m].
  [[nodiscard]] const std::vector<Point>& points() const { return points_; }
  [[nodiscard]] const ElementTree& tree() const { return tree_; }
  [[nodiscard]] const Point& low() const { return low_; }
  [[nodiscard]] const Point& high() const { return high_; }
  /// By how much the pieces may be off the parabola of their side [m].
  [[nodiscard]] double offCurve(int side) const { return offCurve_.empty() ? 0 : offCurve_[side]; }

 private:
  std::vector<Point> points_;
  std::vector<Piece> pieces_;
  ElementTree tree_;
  std::vector<double> offCurve_;
  Point low_, high_;
};

/// A point of the boundary of one of two bodies within the other one.
struct PointInside {
  int of = 0;        ///< 0 or 1: the body whose boundary it is of
  int side = 0;      ///< of that body
  double part = 0;   ///< where on it
  Point at{0, 0};    ///< [m]
  double depth = 0;  ///< its distance to the boundary of the other body [m]
  int across = 0;    ///< the side of the other body that is nearest
  double partAcross = 0;
};

/// A region that two bodies have in common.
struct CommonRegion {
  double area = 0;  ///< [m^2]
  double depth =
      0;  ///< largest distance of a point of one boundary within the other body to its boundary [m]
  Point place{0, 0};                ///< there [m]
  std::vector<PointInside> points;  ///< nodes, and the middle of each piece between two crossings
};

/// \param rounding  of places: boundaries that are as close touch [m]
std::vector<CommonRegion> commonRegions(const MovedOutline& one, const MovedOutline& other, double rounding);

}  // namespace mortier
