// What the materials of a FreeFEM script have beside isotropic elasticity and Perzyna's law.
#pragma once

#include <string>

#include "scene/scene.h"
#include "solver/model.h"

namespace mortier {

/// Macros and numbers of every body (freefem/README.md); nothing where no body has any of it.
std::string freefemMaterials(const SceneDescription& scene);

/// The patches on which bodies average their volumetric strain; nothing where none does.
std::string freefemPatches(const Model& model);

}  // namespace mortier
