// Structured meshes of a rectangle: families for convergence studies without a mesher.
#pragma once

#include "mesh/triangle_mesh.h"

namespace mortier {

struct Rectangle {
  Point lower{0, 0};  ///< lower left corner [m]
  Point upper{1, 1};  ///< upper right corner [m]
  int cellsX = 1;
  int cellsY = 1;
};

/// Each cell cut by its rising diagonal: 2 cellsX cellsY triangles.
/// Labels: 1 bottom, 2 right, 3 top, 4 left. \throws InputError on empty rectangles and cell counts below 1.
TriangleMesh rectangleMesh(const Rectangle& rectangle);

/// Each cell cut by both diagonals: 4 cellsX cellsY triangles. Same labels. The note's meshes are 6x6 and
/// 16x16.
TriangleMesh crissCrossMesh(const Rectangle& rectangle);

}  // namespace mortier
