// What a scene leaves to its meshes, decided once: between reading (scene.h) and building (build.h).
#pragma once

#include <vector>

#include "scene/scene.h"

namespace mortier {

/// A scene and the meshes of its bodies, in their order. Every label is a number that the mesh has, every
/// point of a support a vertex, and every contact has its nonmortar side: what comes later reads them and
/// decides none.
struct ResolvedScene {
  SceneDescription description;
  std::vector<TriangleMesh> meshes;
};

/// Reads or makes the mesh of a body. \throws InputError
TriangleMesh meshOf(const BodyDescription& body);

/// Reads the meshes and decides. \throws InputError with one line that names the scene's file and line, or
/// the mesh's: unreadable meshes, labels and points that a mesh does not have.
ResolvedScene resolveScene(SceneDescription scene);

/// Decides what can be decided in a scene that may be wrong: meshes that could not be read are nullptr, a
/// name that a mesh does not have gets a number that no mesh has, and a contact with such a side and a point
/// that is no vertex stay as they were written.
void resolveWhatCanBe(SceneDescription& scene, const std::vector<const TriangleMesh*>& meshes);

}  // namespace mortier
