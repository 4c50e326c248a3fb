// Families of meshes for convergence studies without a mesher.
#pragma once

#include <optional>

#include "mesh/cells.h"
#include "mesh/triangle_mesh.h"

namespace mortier {

struct Rectangle {
  Point lower{0, 0};  ///< lower left corner [m]
  Point upper{1, 1};  ///< upper right corner [m]
  int cellsX = 1;
  int cellsY = 1;
  /// A point of the rectangle (a node where it is) towards which cells shrink, and by how much: size of the
  /// farthest cells over that of the nearest along x and y, each >= 1.
  std::optional<Point> focus = std::nullopt;
  Point grading{1, 1};
};

/// Labels: 1 bottom, 2 right, 3 top, 4 left. \throws InputError on empty rectangles, cell counts below 1, a
/// focus outside, a grading below 1.
TriangleMesh rectangleMesh(const Rectangle& rectangle, Cut cut = Cut::rising);

/// Each cell cut by both diagonals: 4 cellsX cellsY triangles. The note's meshes are 6x6 and 16x16.
TriangleMesh crissCrossMesh(const Rectangle& rectangle);

/// A quadrilateral, cells bilinear (Cook's membrane: (0, 0), (48, 44), (48, 60), (0, 44)).
struct Quadrilateral {
  std::array<Point, 4> corners;  ///< counterclockwise [m]
  int cells1 = 1;                ///< along the first side, from corner 0 to 1
  int cells2 = 1;                ///< along the second side
};

/// Labels 1 to 4: side k from corner k to the next, corners numbered from 1. \throws InputError
TriangleMesh quadrilateralMesh(const Quadrilateral& quadrilateral, Cut cut = Cut::rising);

/// A ring or a sector of it about the centre, from the positive x axis counterclockwise.
struct Annulus {
  Point centre{0, 0};
  double inner = 1;  ///< radii [m]
  double outer = 2;
  int quarters = 4;     ///< 1, 2 or 4: a quarter, a half, all of it
  int cellsAround = 1;  ///< in all
  int cellsAcross = 1;  ///< radii in geometric progression: all cells are alike
};

/// Labels: 1 inner circle, 2 outer circle; of a sector 3 the side on the x axis where it begins, 4 where it
/// ends. \throws InputError
TriangleMesh annulusMesh(const Annulus& annulus, Cut cut = Cut::rising);

/// The lower half of a disc, fine around its lowest point: equal cells in a core about that point, then
/// cells that grow with the distance from it. For Hertz contact.
struct HalfDisc {
  Point lowest{0, 0};    ///< [m]
  double radius = 1;     ///< [m]
  double core = 0.1;     ///< half width of the core [m], below a third of the radius
  int cells = 8;         ///< on the half width of the core
  bool quarter = false;  ///< only what is right of the lowest point: the section of a sphere
};

/// Labels: 1 the arc within 45 degrees of the lowest point, 2 the flat side on top, 3 the rest of the arc; of
/// a quarter 4 the vertical side.
/// Symmetric to the last bit about the vertical axis where cells are cut by both diagonals; inside the arc
/// every node has as many triangles as its neighbours, whatever the cut. \throws InputError
TriangleMesh halfDiscMesh(const HalfDisc& disc, Cut cut = Cut::both);

}  // namespace mortier
