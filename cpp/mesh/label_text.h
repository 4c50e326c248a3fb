// Labels in messages.
#pragma once

#include <string>

#include "mesh/triangle_mesh.h"

namespace mortier {

/// `label 3 "top"`, or `label 3` where the mesh has no name for it.
inline std::string labelText(const TriangleMesh& mesh, int label) {
  for (const auto& [name, number] : mesh.labelNames)
    if (number == label) return "label " + std::to_string(label) + " \"" + name + "\"";
  return "label " + std::to_string(label);
}

}  // namespace mortier
