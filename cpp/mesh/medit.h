// Medit .mesh files (ASCII, two-dimensional), as FreeFEM reads and writes them; coordinates survive bit by
// bit.
#pragma once

#include <string>

#include "mesh/triangle_mesh.h"

namespace mortier {

/// Reads and validates. Vertices, Edges and Triangles are kept (vertex labels are not); sections that only
/// guide a mesher (Corners, RequiredVertices, ...) are skipped. \throws InputError `file:line: ...` on
/// anything that is not a sound mesh, unknown keywords and a missing End included.
TriangleMesh readMedit(const std::string& path);

/// Writes each coordinate with the fewest digits (17 at most) that read back as the same bits.
/// \throws OutputError when the file cannot be written.
void writeMedit(const TriangleMesh& mesh, const std::string& path);

}  // namespace mortier
