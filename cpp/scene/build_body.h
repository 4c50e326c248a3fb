// From a [[body]] of a scene to a Body: mesh read, labels found in it, data tried, material and conditions
// made.
#pragma once

#include <string>
#include <vector>

#include "fem/body.h"
#include "scene/scene.h"

namespace mortier {

/// Data are tried at `times` [s]. Doubtful but legal input is added to `warnings`, one line each.
/// \throws InputError with one line that names the scene's file and line, or the mesh's.
Body buildBody(BodyDescription body, Plane plane, const std::vector<double>& times,
               std::vector<std::string>& warnings);

}  // namespace mortier
