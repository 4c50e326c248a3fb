// A labelled part of a mesh's boundary as one oriented polygonal line: the trace on which contact is
// discretised.
#pragma once

#include <array>
#include <vector>

#include "mesh/triangle_mesh.h"

namespace mortier {

/// Nodes along a labelled boundary, in the order in which the boundary edges run (the body to the left).
struct BoundaryLine {
  std::vector<int> nodes;     ///< vertex numbers; the first and last agree on a closed line
  std::vector<Point> points;  ///< their coordinates [m]
  bool closed = false;
  std::vector<Point> middles =
      {};  ///< TriangleMesh::edgeMiddles of the elements; empty where none is known [m]
};

/// \throws InputError when the label is missing, or when its edges do not form one connected line.
BoundaryLine boundaryLine(const TriangleMesh& mesh, int label);

/// The labels present on the boundary, ascending, each once.
std::vector<int> boundaryLabels(const TriangleMesh& mesh);

/// The edges that carry a label, in the mesh's order; none where the label is missing.
std::vector<std::array<int, 2>> edgesOn(const TriangleMesh& mesh, int label);

/// The vertices of those edges, ascending, each once.
std::vector<int> verticesOn(const TriangleMesh& mesh, int label);

}  // namespace mortier
