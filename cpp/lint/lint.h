// The linter: names what is wrong or doubtful in a scene and its meshes, each with its remedy, without
// solving anything.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "lint/fault.h"
#include "lint/topology.h"
#include "plan/loads.h"
#include "scene/resolve.h"
#include "solver/model.h"

namespace mortier {

/// What the checks look at.
struct LintInput : MeshedScene {
  std::vector<Topology> topologies;  ///< of the meshes
  std::vector<double> interference =
      {};  ///< of each contact: how deep the bodies overlap in it, 0 where they do not [m]

  /// `file:line` of a key of the scene, or of the innermost table above it; `body`: of the first key, body,
  /// that with this index.
  [[nodiscard]] std::string where(const std::vector<std::string>& keys, size_t body = 0) const;
};

struct LintReport {
  Faults faults;
  std::optional<SceneDescription> scene;  ///< none where it cannot be read
  std::optional<Model> model;             ///< none where a run would refuse the scene
};

/// An error that a run would end with, as a fault. \param id  where it does not say of which kind it is
void addError(const InputError& error, const std::string& id, Faults& faults);

/// Everything. \throws nothing that a scene could cause: errors become faults.
LintReport lint(const std::string& scene, const std::vector<std::string>& settings);

/// The faults of a resolved scene that are found without building or solving anything; `lint` reports the
/// same ones, word for word.
Faults lintResolved(const ResolvedScene& resolved);

/// The faults that only the model shows.
void lintModel(const SceneDescription& scene, const Model& model, Faults& faults);

/// The message of the initial equilibrium, if any (scene/build.h).
void lintSettling(const SceneDescription& scene, const std::string& doubt, Faults& faults);

/// Whether the meshes of the scene are first ones, which the run refines until an accuracy is reached: how
/// fine they are and which side is the finer one is not for the scene to say.
inline bool refinesMeshes(const SceneDescription& scene) {
  return scene.accuracy.asked() > 0;
}

/// By how much supports move the nonmortar body of a contact against the mortar one at a time, as far as they
/// move all of both [m].
Point supportedMotion(const LintInput& input, const ContactDescription& contact, double t);

// What the linter looks for, one file each.
void lintMeshes(const LintInput& input, Faults& faults);
/// The same of bodies in space.
void lintMeshes(const std::vector<TetrahedronMesh>& meshes, Faults& faults);
void lintLabels(const LintInput& input, Faults& faults);
void lintContacts(const LintInput& input, Faults& faults);
void lintDeformations(const LintInput& input, Faults& faults);
/// The same of bodies that supports press into each other.
void lintApproach(const LintInput& input, const ContactDescription& contact, ContactInterface interface,
                  Faults& faults);
void lintBodies(const LintInput& input, Faults& faults);
void lintMaterials(const LintInput& input, Faults& faults);
/// Of these, those of bodies in space.
void lintVolumes(const SceneDescription& scene, Faults& faults);
void lintLoads(const LintInput& input, Faults& faults);
void lintTime(const LintInput& input, Faults& faults);
/// Data in space, against what the meshes make of them.
void lintData(const SceneDescription& scene, const Model& model, Faults& faults);

}  // namespace mortier
