// The state at t = 0 of a scene: initial stresses brought into equilibrium.
#pragma once

#include <string>

#include "scene/scene.h"
#include "time/march.h"

namespace mortier {

/// Brings the initial stresses of `state`, where there are any, into equilibrium (time/initial_balance.h).
/// \returns what a user may not have meant: by how much they changed; empty where they were in equilibrium.
/// \throws InputError, UnheldBodyError
std::string findInitialEquilibrium(const SceneDescription& scene, const Model& model, State& state);

}  // namespace mortier
