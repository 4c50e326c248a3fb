// Medit .mesh files (ASCII, two-dimensional), as FreeFEM reads and writes them; coordinates survive bit by bit.
#pragma once

#include <string>

#include "mesh/triangle_mesh.h"

namespace mortier {

/// Reads and validates. \throws InputError `file:line: ...` on anything that is not a sound mesh.
TriangleMesh readMedit(const std::string& path);

/// Writes with 17 significant digits. \throws OutputError when the file cannot be written.
void writeMedit(const TriangleMesh& mesh, const std::string& path);

}  // namespace mortier
