// From a scene to what is solved: meshes read, conditions checked against them, bodies and interfaces made.
#pragma once

#include <string>
#include <vector>

#include "scene/scene.h"
#include "time/march.h"

namespace mortier {

/// \throws InputError with one line that names the scene's file and line (or the mesh's): unreadable meshes,
/// labels that a mesh does not have, data that are not finite somewhere, corners with two displacements,
/// bodies that do not face each other. Doubtful but legal input is added to `warnings`, one line each.
Model buildModel(const SceneDescription& scene, std::vector<std::string>& warnings);

/// Of the bodies.
std::vector<const TriangleMesh*> meshesOf(const Model& model);

}  // namespace mortier
