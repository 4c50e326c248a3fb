// A labelled part of a mesh's boundary as one oriented polygonal line: the trace on which contact is
// discretised.
#pragma once

#include <vector>

#include "mesh/triangle_mesh.h"

namespace mortier {

/// Nodes along a labelled boundary, in the order in which the boundary edges run (the body to the left).
struct BoundaryLine {
  std::vector<int> nodes;     ///< vertex numbers; the first and last agree on a closed line
  std::vector<Point> points;  ///< their coordinates [m]
  bool closed = false;
};

/// \throws InputError when the label is missing, or when its edges do not form one connected line.
BoundaryLine boundaryLine(const TriangleMesh& mesh, int label);

/// The labels present on the boundary, ascending, each once.
std::vector<int> boundaryLabels(const TriangleMesh& mesh);

}  // namespace mortier
