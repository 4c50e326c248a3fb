// Families of meshes for convergence studies without a mesher.
#pragma once

#include <array>
#include <functional>
#include <optional>
#include <string>

#include "mesh/triangle_mesh.h"

namespace mortier {

// Meshes made of quadrilateral cells, each cut into triangles: what the families are built from.

/// How a cell with corners a, b, c, d (counterclockwise) is cut.
enum class Cut {
  rising,   ///< by a-c
  falling,  ///< by b-d
  both      ///< by both diagonals, which meet in a new vertex
};

/// A grid of n1 x n2 cells: node (i, j) is at(i, j), counterclockwise where i runs right and j up.
struct Grid {
  int n1 = 1;
  int n2 = 1;
  std::function<Point(int i, int j)> at;
  bool closed = false;  ///< node (n1, j) is node (0, j)
  std::array<int, 4> labels{
      1, 2, 3, 4};  ///< of j = 0, i = n1, j = n2, i = 0; only the first and third count when closed
};

/// Nodes j by j, then the centres of cells; region 1, validated. \throws InputError
TriangleMesh gridMesh(const Grid& grid, Cut cut, const std::string& name);

/// Node i of n cells on [a, b] whose sizes grow geometrically with the distance from `focus` (in [a, b]; it
/// is a node): at the farther end they are `grading` times those at the focus. grading = 1: equal cells.
std::vector<double> gradedNodes(double a, double b, int n, double focus, double grading);

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
