#pragma once

#include <vector>

#include "scene/scene.h"
#include "solver/model.h"

namespace mortier {

/// What a resolved scene asks for. \throws InputError with file and line: a label without supports has no
/// reaction, one that is no side of contact no contact force, and a point outside of its body no
/// displacement.
std::vector<Quantity> buildQuantities(const SceneDescription& scene, const Model& model);

}  // namespace mortier
