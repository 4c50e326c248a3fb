// Contact that meshes are too coarse to decide: between two surfaces in space of which no row presses,
// although they are nearer to each other than what is known of their distance.
#pragma once

#include <optional>

#include "adapt/rounds.h"
#include "solver/model.h"
#include "solver/state.h"

namespace mortier {

/// Where surfaces of such a contact are deepest in each other, their expected error (ContactSurface::
/// offsetError) included; of distances that are given none is expected. \param state  at the end of the run
std::optional<MissedContact> unclearContact(const Model& model, const State& state);

}  // namespace mortier
