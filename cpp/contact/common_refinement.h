// The common refinement of a part of the nonmortar line and the mortar line: the pieces of the part on each
// of which it faces one element of the mortar line. A point x1(s) faces the nearest point x2 of the mortar
// line on the ray through it along the direction of contact n(s) (directions.h),
//
//   x2 = x1 + d n,   n(s) interpolated between the vertices of the part,
//
// where the line runs along the part. So a piece depends on where lines are, not on how they are cut: on no
// end of a mortar element that faces nothing, and on no element whose points are farther off than others.
// Elements whose directions make more than 60 degrees do not face each other; a corner may face an element
// at any angle (CornerContact).
#pragma once

#include <functional>
#include <optional>
#include <vector>

#include "contact/directions.h"

namespace mortier {

/// x1(s) and the point that it faces, and the direction of the line through both, so that opposite forces
/// along it have no moment.
struct FacingPair {
  EdgeValues phi;       ///< shape functions of the nonmortar element at x1
  EdgeValues psi;       ///< of the mortar element at x2; linear in s where n is constant
  Point normal;         ///< direction n, of length one
  double stretch = 1;   ///< length of the element by its abscissa; not 1 where it is bent
  double distance = 0;  ///< of the two lines along n [m]
  double curvatureCorrection =
      0;  ///< what the curves that the elements stand for (smooth_part.h) take from it [m]
};

/// Distance g0 of the bodies at a place of a nonmortar element [m].
using DistanceAt = std::function<double(int element, double s, const FacingPair& facing)>;

/// As meshed, of the curves that the lines stand for.
inline double distanceOfCurves(int /*element*/, double /*s*/, const FacingPair& facing) {
  return facing.distance - facing.curvatureCorrection;
}

/// A piece of the part.
struct Segment {
  int nonmortar = 0;  ///< element of the part
  int mortar = 0;     ///< element of the mortar line
  double begin = 0;   ///< abscissae on the part [m]
  double end = 0;
};

/// A node of the part (ElementLine::nodesOf) with the point that it faces, and their elements.
struct FacingNode {
  FacingPair facing;
  Segment place;
};

class CommonRefinement {
 public:
  /// Part and line must outlive it. \param mortarShare, kept  contactDirections()
  CommonRefinement(const SmoothPart& part, const MortarLine& mortar,
                   std::optional<double> mortarShare = std::nullopt, const ContactDirections* kept = nullptr);
  /// Of a part that faces nothing.
  explicit CommonRefinement(const SmoothPart& part);

  [[nodiscard]] const SmoothPart& part() const { return *part_; }
  [[nodiscard]] const MortarLine& mortar() const { return *mortar_; }
  /// By abscissae.
  [[nodiscard]] const std::vector<Segment>& segments() const { return segments_; }
  /// Whether the part faces nothing, with no corner either.
  [[nodiscard]] bool empty() const { return segments_.empty() && directions_.corners.empty(); }
  [[nodiscard]] const ContactDirections& directions() const { return directions_; }
  [[nodiscard]] const std::vector<CornerContact>& corners() const { return directions_.corners; }
  /// Of the part that faces the mortar line [m].
  [[nodiscard]] double length() const;
  /// Whether a vertex of the part faces the mortar line, or would, moved by a millionth of an element.
  [[nodiscard]] bool faces(int vertex) const { return !pieceAt_.empty() && pieceAt_[vertex] >= 0; }
  /// Pieces of an element: the first of segments() and the one after the last.
  [[nodiscard]] std::array<int, 2> piecesOf(int element) const {
    return {firstPiece_[element], firstPiece_[element + 1]};
  }
  [[nodiscard]] FacingPair pairAt(const Segment& segment, double s) const;
  /// \pre not empty(). A node beside the pieces faces the element of the nearest one, extended.
  [[nodiscard]] FacingNode facingOfNode(int node) const;
  /// The direction of contact at a node of the part.
  [[nodiscard]] Point directionAt(int node) const;
  /// Abscissae at which the part faces the nodes of the elements that it faces, ascending.
  [[nodiscard]] Trace mortarNodes() const;

 private:
  void refine(int element);
  void findVertices();
  [[nodiscard]] Point ray(int element, double xi) const;

  const SmoothPart* part_;
  const MortarLine* mortar_ = nullptr;
  ContactDirections directions_;
  std::vector<Segment> segments_;
  std::vector<int> firstPiece_{0};
  std::vector<int> pieceAt_;  ///< by vertices: a segment that they lie on; -1: none
};

}  // namespace mortier
