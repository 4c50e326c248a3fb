// Parts drawn together: the regions of a mesh that make one body.
#pragma once

#include <string>
#include <vector>

#include "mesh/tetrahedron_mesh.h"
#include "mesh/triangle_mesh.h"

namespace mortier {

/// Keeps the regions with these names or numbers, and of the labelled edges those on their boundary, which
/// may have been inside the mesh. Vertices that two of them share stay shared; those that a region shares
/// with those that are left out become its own. \throws InputError that lists the regions of the mesh.
void keepRegions(TriangleMesh& mesh, const std::vector<std::string>& regions);
void keepRegions(TetrahedronMesh& mesh, const std::vector<std::string>& regions);

/// Drops labelled edges between two triangles, which are of no use as a boundary.
void dropInnerEdges(TriangleMesh& mesh);
/// The same of labelled triangles between two tetrahedra.
void dropInnerTriangles(TetrahedronMesh& mesh);

}  // namespace mortier
