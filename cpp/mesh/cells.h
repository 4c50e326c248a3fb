// Meshes made of quadrilateral cells, each cut into triangles: what the families are built from.
#pragma once

#include <array>
#include <functional>
#include <string>

#include "mesh/triangle_mesh.h"

namespace mortier {

/// How a cell with corners a, b, c, d (counterclockwise) is cut.
enum class Cut {
  rising,   ///< by a-c
  falling,  ///< by b-d
  both      ///< by both diagonals, which meet in a new vertex
};

/// \throws InputError unless there is one cell or more each way, and 1e8 triangles at most.
void checkCells(const std::string& name, double cells1, double cells2, Cut cut);

/// Adds the triangles of one cell. That the new vertex is where both diagonals meet lets the four triangles
/// keep their volume in plane strain without locking (Nagtegaal, Parks and Rice 1974); a cell that is not
/// convex has the mean of its corners.
void addCell(TriangleMesh& mesh, const std::array<int, 4>& corners, Cut cut);

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

/// Region 1 everywhere, validated. \throws InputError
TriangleMesh finished(TriangleMesh mesh, const std::string& name);

/// Node i of n cells on [a, b] whose sizes grow geometrically with the distance from `focus` (in [a, b]; it
/// is a node): at the farther end they are `grading` times those at the focus. grading = 1: equal cells.
std::vector<double> gradedNodes(double a, double b, int n, double focus, double grading);

}  // namespace mortier
