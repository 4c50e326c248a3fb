// Where the estimate of the error of the stress (fem/error_estimate.h) is known to be wrong, and by how much:
// docs/measurements.md has the ratios.
#pragma once

#include <string>
#include <vector>

#include "scene/scene.h"
#include "solver/model.h"
#include "solver/state.h"
#include "time/quantity.h"

namespace mortier {

/// A line each, with the range of the estimate over the error.
std::vector<std::string> estimateDoubts(const SceneDescription& scene, const Model& model);

/// The points at which supports exert a force in a state, a line each: the energy of the exact solution is
/// infinite there, so its error does not fall.
std::vector<std::string> pointForceDoubts(const Model& model, const State& state);

struct ContactDoubt {
  enum class Unknown { nothing, pressures, force };
  size_t interface = 0;
  Unknown unknown = Unknown::nothing;  ///< what has no digit; of a force its pressures neither
  std::string text;
};

/// Contacts whose pressures the meshes do not resolve in a state: those that end within a side after a few
/// cells, and sides that overlap between their nodes without a force.
/// \param largestForce  the largest contact force of the run; forces below its rounding are ignored [N/m]
std::vector<ContactDoubt> contactDoubts(const Model& model, const State& state, double largestForce);

/// Whether a contact of which there is a doubt does not have a value. \param ofPart  of a part of a side
bool leavesUnknown(const ContactDoubt& doubt, const Quantity& quantity, bool ofPart, const Model& model);

/// Whether every nonmortar node lies on a mortar node, and the mortar nodes between them on nonmortar ones.
bool meshesMatch(const ContactInterface& interface);

}  // namespace mortier
