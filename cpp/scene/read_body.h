// One [[body]] of a scene: its mesh, materials, regions, forces and boundary conditions.
#pragma once

#include <string>

#include "scene/document.h"
#include "scene/scene.h"

namespace mortier {

/// `scenePath` is the file that names the mesh; `index` names a body that has no name yet.
/// \throws InputError with one line `file:line: body NAME: key = value, expected ...`.
BodyDescription readBody(const Node& node, const std::string& scenePath, size_t index);

}  // namespace mortier
