// What of a mesh hangs together: components of triangles that share edges are rigid in themselves; where two
// of them share a single vertex they can turn about it, as about a hinge.
#pragma once

#include <vector>

#include "mesh/triangle_mesh.h"

namespace mortier {

struct EdgeComponents {
  int count = 0;
  std::vector<int> of;  ///< component of each triangle, numbered in the order of their first triangles
};

/// Triangles that share edges, directly or through others. In linear time.
EdgeComponents edgeComponents(const TriangleMesh& mesh);

}  // namespace mortier
