// The curves for which the boundary of a mesh stands, as far as they are known, so that a refined mesh tends
// to the body and not to its first polygon: the mesh's own (TriangleMesh::edgeCurves, edgeMiddles), else the
// arcs of circles that its nodes lie on (contact/smooth_part.h: four nodes at least, to 1e-6). What is
// straight is known, too. Lines inside, where two regions meet, are fitted as well.
#pragma once

#include <string>
#include <vector>

#include "mesh/refine.h"

namespace mortier {

struct KnownCurves {
  CurvedEdges edges;  ///< without those of TriangleMesh::edgeCurves
  /// The lines of which no curve is known: their polygons are kept.
  std::vector<std::string> polygons;  ///< "label 3", "its boundary without a label", "its regions"
};

KnownCurves curvesBehind(const TriangleMesh& mesh);

}  // namespace mortier
