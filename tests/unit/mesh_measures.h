// Sums and extremes over a mesh that tests ask for.
#pragma once

#include <algorithm>

#include "mesh/triangle_mesh.h"

namespace mortier {

inline double area(const TriangleMesh& mesh) {
  double sum = 0;
  for (int t = 0; t < static_cast<int>(mesh.triangles.size()); ++t) sum += doubleArea(mesh, t) / 2;
  return sum;
}

inline double worstAspect(const TriangleMesh& mesh) {
  double worst = 0;
  for (int t = 0; t < static_cast<int>(mesh.triangles.size()); ++t)
    worst = std::max(worst, aspectRatio(mesh, t));
  return worst;
}

}  // namespace mortier
