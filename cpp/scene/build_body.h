// From a [[body]] of a resolved scene and its mesh to a Body: data tried, material and conditions made.
#pragma once

#include <string>
#include <vector>

#include "fem/body.h"
#include "scene/scene.h"

namespace mortier {

/// Data are tried at `times` [s]. Doubtful but legal input is added to `warnings`, one line each.
/// \throws InputError with one line that names the scene's file and line, or the mesh's.
Body buildBody(const BodyDescription& body, TriangleMesh mesh, Plane plane, const std::vector<double>& times,
               std::vector<std::string>& warnings);

}  // namespace mortier
