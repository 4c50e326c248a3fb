// Meshes of tetrahedra that tests share, and sums over them.
#pragma once

#include <cmath>

#include "mesh/shape.h"

namespace mortier {

inline double volumeOf(const TetrahedronMesh& mesh) {
  double sum = 0;
  for (const auto& tetrahedron : mesh.tetrahedra) sum += volume(mesh, tetrahedron);
  return sum;
}

/// The part x, y >= 0 of a ball of radius 1: a box whose cubes about the middle become spheres.
inline TetrahedronMesh quarterBall(int cells) {
  TetrahedronMesh mesh = cuboidMesh({{0, 0, -1}, {1, 1, 1}, {cells, cells, 2 * cells}});
  for (SpacePoint& x : mesh.vertices)
    if (x.norm() > 0) x *= x.cwiseAbs().maxCoeff() / x.norm();
  for (int& label : mesh.boundaryLabels)
    if (label != 4 && label != 5) label = 1;
  validate(mesh);
  return mesh;
}

}  // namespace mortier
