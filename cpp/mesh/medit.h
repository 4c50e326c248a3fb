// Medit .mesh files (ASCII), as FreeFEM and Gmsh read and write them; coordinates survive bit by bit. The
// format has no names for labels. They stand in lines after its End, which other readers do not see:
//   # label 3 = top
//   # region 1 = punch
#pragma once

#include <string>
#include <vector>

#include "mesh/tetrahedron_mesh.h"
#include "mesh/triangle_mesh.h"

namespace mortier {

/// Reads and validates. Vertices, Edges and Triangles are kept (vertex labels are not); sections that only
/// guide a mesher (Corners, RequiredVertices, ...) are skipped. Of the regions those that are named
/// (mesh/regions.h), all where none is. A third coordinate must be the same everywhere. \throws InputError
/// `file:line: ...` on anything that is not a sound mesh, unknown keywords and a missing End included.
TriangleMesh readMedit(const std::string& path, const std::vector<std::string>& regions = {});
/// The same in space: Vertices, Tetrahedra and Triangles are kept, the triangles as the labelled boundary.
TetrahedronMesh readSpaceMedit(const std::string& path, const std::vector<std::string>& regions = {});

/// Writes the names of labels too, and each coordinate with the fewest digits (17 at most) that read back as
/// the same bits.
/// \throws OutputError when the file cannot be written.
void writeMedit(const TriangleMesh& mesh, const std::string& path);
void writeMedit(const TetrahedronMesh& mesh, const std::string& path);

/// What it writes.
std::string meditText(const TriangleMesh& mesh);
std::string meditText(const TetrahedronMesh& mesh);

}  // namespace mortier
