// The text of a Medit file as a mesh.
#pragma once

#include <string>
#include <string_view>
#include <vector>

#include "mesh/tetrahedron_mesh.h"
#include "mesh/triangle_mesh.h"

namespace mortier {

struct MeditText {
  std::string path;  ///< for messages
  std::string_view text;
  /// Whether the text is what another file was converted to: items stand in it once for each group, triangles
  /// run in either sense, and its lines are not those of the file.
  bool converted = false;
  size_t quadratic = 0;  ///< cells of the file that lost the nodes on their edges
};

/// \param regions  as of readMedit. \throws InputError
TriangleMesh parseMedit(const MeditText& text, const std::vector<std::string>& regions);
TetrahedronMesh parseSpaceMedit(const MeditText& text, const std::vector<std::string>& regions);

}  // namespace mortier
