// From a [[body]] of a resolved scene and its mesh to a Body: data tried, material and conditions made.
#pragma once

#include <vector>

#include "fem/body.h"
#include "scene/scene.h"

namespace mortier {

/// \param places  the points of the material, which an angle of its axes may depend on.
/// \throws InputError
std::shared_ptr<const Material> buildMaterial(const MaterialDescription& description, Plane plane,
                                              const std::vector<Point>& places);

/// Data are tried at `times` [s].
/// \throws InputError with one line that names the scene's file and line, or the mesh's.
Body buildBody(const BodyDescription& body, TriangleMesh mesh, const SceneDescription& scene,
               const std::vector<double>& times);

}  // namespace mortier
