// When the data of a scene change abruptly.
#pragma once

#include <vector>

#include "scene/scene.h"
#include "solver/model.h"

namespace mortier {

/// Kinks and jumps in time of displacements, tractions and body forces and the breaks that the scene names,
/// ascending [s]. Tables tell all of theirs; expressions are tried at a few points where they act.
std::vector<double> loadBreaks(const SceneDescription& scene, const Model& model);

}  // namespace mortier
