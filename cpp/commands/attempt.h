// A scene and all that comes of it: its model, what is reported of it, and what was found. A run is one of
// them, or a round of a run that refines its meshes.
#pragma once

#include <memory>
#include <string>

#include "bound/flow_bound.h"
#include "bound/total_bound.h"
#include "report/accuracy.h"
#include "scene/resolve.h"

namespace mortier {

struct AttemptOptions {
  int threads = 1;
  bool share = false;  ///< whether ranks may share it
};

/// Its members refer to each other.
struct Attempt {
  ResolvedScene resolved;
  std::unique_ptr<Model> model;              ///< of ranks that share it but the first, in parts
  std::unique_ptr<Model> parts;              ///< of the first of such ranks
  std::string whyNotShared;                  ///< why ranks cannot share it; empty where they do
  std::unique_ptr<CurrentSpaceError> error;  ///< of the meshes, in the state that the run is at
  RunFacts facts;
  Solved solved;  ///< before the march the state in which it begins

  /// \throws InputError, UnheldBodyError
  Attempt(ResolvedScene scene, const AttemptOptions& options);
  Attempt(const Attempt&) = delete;
  Attempt& operator=(const Attempt&) = delete;

  /// The model that is solved: the one of this rank.
  [[nodiscard]] const Model& solvedModel() const { return parts ? *parts : *model; }
  [[nodiscard]] const SceneDescription& scene() const { return resolved.description; }

 private:
  void share();
};

// Bounds of its error (bound/): whatever goes wrong in them is their obstacle, the result stays.

/// Of its last state and its quantities.
EnergyBound boundOf(const Attempt& attempt);
/// Of what the meshes do to its last step.
EnergyBound stepBoundOf(const Attempt& attempt);
FlowBound flowBoundOf(const FlowBoundRecord& record, const State& state);
TotalBound totalBoundOf(const TotalBoundRecord& record, const State& state, const FlowBound& steps);

}  // namespace mortier
