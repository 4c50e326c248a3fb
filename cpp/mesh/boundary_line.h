// A labelled part of a mesh's boundary as one oriented polygonal line: the trace on which contact is
// discretised.
#pragma once

#include <algorithm>
#include <array>
#include <vector>

#include "mesh/element_nodes.h"
#include "mesh/simplices.h"

namespace mortier {

/// Nodes along a labelled boundary, in the order in which the boundary edges run (the body to the left).
struct BoundaryLine {
  std::vector<int> nodes;     ///< vertex numbers; the first and last agree on a closed line
  std::vector<Point> points;  ///< their coordinates [m]
  bool closed = false;
  /// TriangleMesh::edgeMiddles of the elements; empty where none is known [m]
  std::vector<Point> middles = {};
  std::vector<EdgeCurve> curves = {};  ///< the same of TriangleMesh::edgeCurves
  /// Nodes in the middle of the elements and their places [m]; empty where displacements are linear.
  std::vector<int> middleNodes = {};
  std::vector<Point> middlePoints = {};
};

/// \throws InputError when the label is missing, or when its edges do not form one connected line.
BoundaryLine boundaryLine(const TriangleMesh& mesh, int label);
/// The same with the nodes in the middle of its elements.
BoundaryLine boundaryLine(const TriangleMesh& mesh, const ElementNodes& nodes, int label);

/// The first vertex that lies exactly at a place [m]; -1 for none.
template <class Mesh, class Place>
int vertexAt(const Mesh& mesh, const Place& place) {
  const auto found = std::find(mesh.vertices.begin(), mesh.vertices.end(), place);
  return found == mesh.vertices.end() ? -1 : static_cast<int>(found - mesh.vertices.begin());
}

}  // namespace mortier
