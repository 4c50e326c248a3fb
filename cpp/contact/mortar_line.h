// The mortar line as the nonmortar line faces it, and the points of it along a ray.
#pragma once

#include <array>
#include <memory>
#include <vector>

#include "contact/element_tree.h"
#include "contact/smooth_part.h"

namespace mortier {

/// Geometry of an element of the mortar line, at its two ends.
struct MortarElement {
  std::array<Point, 2> normals;                        ///< outward of the mortar body
  std::array<double, 2> curvatures{};                  ///< without sign [1/m]
  std::array<double, 2> toCorner{infinity, infinity};  ///< from each end on, along the line [m]
  std::array<Point, 2> behindCorner;                   ///< normals behind these corners
  Arc arc;                                             ///< as the mortar body runs
  std::shared_ptr<const SmoothPart> drawn = nullptr;   ///< of its part, if that has moved
  int part = 0;                                        ///< number of its smooth part
  int inPart = 0;                                      ///< the element there
};

/// The point of a line on a ray x + d n.
struct LineHit {
  int element = -1;            ///< -1: none
  double xi = 0;               ///< part of the element
  double distance = infinity;  ///< d, negative where the bodies overlap [m]

  [[nodiscard]] bool found() const { return element >= 0; }
};

/// The mortar line, against the direction of its body, with the normals and curvatures of its smooth parts.
/// It has no abscissae.
struct MortarLine : ElementLine {
  explicit MortarLine(const BoundaryLine& boundary)
      : MortarLine(smoothParts(boundary, Kinks::ofStraightElements), boundary.closed) {}
  MortarLine(const std::vector<SmoothPart>& parts, bool closed);

  std::vector<MortarElement> geometry;  ///< by elements
  bool closed = false;
  ElementTree tree;

  /// The nearest point on the line through x along n that x faces: n points into the mortar body there, and
  /// no other point of the line lies between.
  [[nodiscard]] LineHit along(const Point& x, const Point& n) const;
  /// Whether n makes less than 75 degrees with the direction into the mortar body.
  [[nodiscard]] bool mayFace(int element, double xi, const Point& n) const;
  /// The nearest to x of the points of the line that n may face.
  [[nodiscard]] LineHit nearestTo(const Point& x, const Point& n) const;
  /// The part of an element at which (y - x) x n = 0, beyond its ends where that is there.
  [[nodiscard]] double partAlong(int element, const Point& x, const Point& n) const;
  /// Between the ends of an element; at the nearer end beyond them.
  [[nodiscard]] Point normalAt(int element, double xi) const;
  [[nodiscard]] double curvatureAt(int element, double xi) const;
  /// Along the line from a point to the nearest corner of it [m].
  [[nodiscard]] double toCorner(int element, double xi) const;
  /// The same of corners behind which the line may be faced along n: lengths over a factor that falls from 1
  /// where n and the normal behind the corner make 60 degrees to 0 where they make 75.
  [[nodiscard]] double toCorner(int element, double xi, const Point& n) const;
  [[nodiscard]] Point direction(int element) const {
    return (points[element + 1] - points[element]).normalized();
  }
};

}  // namespace mortier
