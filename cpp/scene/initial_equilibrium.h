// How far initial stresses are from equilibrium with what acts at t = 0.
#pragma once

#include <string>

#include "scene/scene.h"
#include "time/march.h"

namespace mortier {

/// \returns what a user may not have meant: by how much the initial stresses of `state` change at t = 0
/// (time/initial_balance.h); empty where they are in equilibrium.
/// \throws InputError, UnheldBodyError
std::string findInitialEquilibrium(const SceneDescription& scene, const Model& model, State state);

}  // namespace mortier
