// A scene and all that comes of it: its model, what is reported of it, and what was found. A run is one of
// them, or a round of a run that refines its meshes.
#pragma once

#include <memory>
#include <string>

#include "report/accuracy.h"
#include "scene/resolve.h"

namespace mortier {

/// Its members refer to each other.
struct Attempt {
  ResolvedScene resolved;
  std::unique_ptr<Model> model;
  std::unique_ptr<CurrentMeshError> error;  ///< of the meshes, in the state that the run is at
  RunFacts facts;
  Solved solved;  ///< before the march the state in which it begins

  /// \throws InputError, UnheldBodyError
  Attempt(ResolvedScene scene, int threads);
  Attempt(const Attempt&) = delete;
  Attempt& operator=(const Attempt&) = delete;

  [[nodiscard]] const SceneDescription& scene() const { return resolved.description; }
};

/// The state in which a run of the scene begins: bodies at rest, or as another run has left them. \throws
/// InputError where that is no state of these bodies
State startOf(const SceneDescription& scene, const Model& model);

/// The bound of the error of its last state and its quantities (bound/energy_bound.h): whatever goes wrong in
/// it is its obstacle, the result stays.
EnergyBound boundOf(const Attempt& attempt);

}  // namespace mortier
