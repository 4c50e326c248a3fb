// From a resolved scene to what is solved: conditions checked against the meshes, bodies and interfaces made.
#pragma once

#include "scene/resolve.h"
#include "time/march.h"

namespace mortier {

/// The meshes of the scene become those of the model. What is doubtful but legal, the linter names.
/// \throws InputError with one line that names the scene's file and line (or the mesh's): data that are not
/// finite somewhere, corners with two displacements, bodies that do not face each other.
Model buildModel(ResolvedScene& scene);

}  // namespace mortier
