// Ends and corners of a contact line make stresses of the body that it faces unbounded or kinked, and nothing
// of the other mesh need be there: inside an edge no vertex ever comes near enough, and the estimate sees
// half of it. So a vertex is put there.
#pragma once

#include <vector>

#include "mesh/refine.h"

namespace mortier {

/// Ends of a labelled line, and vertices where it turns by more than `sharpTurn`. \throws InputError
std::vector<Point> cornersOf(const TriangleMesh& mesh, int label);

/// Cuts the edges of a labelled line that places face, where these are not next to a vertex (a tenth of the
/// edge) or farther away than the edge is long, and the triangles behind them. Curved edges stay as they are.
void cutFacing(TriangleMesh& mesh, const CurvedEdges& curves, int label, const std::vector<Point>& places);

/// Of the triangles of a mesh, those with an edge on a labelled line that is longer than twice an edge of the
/// line that it faces. \throws InputError
std::vector<char> longerThanFacing(const TriangleMesh& mesh, int label, const TriangleMesh& other,
                                   int otherLabel);

}  // namespace mortier
