// Forces that act on the nodes of a body at one state, beside its loads:
//   C' p  what contact takes from it (it gets -C' p),
//   r = sum |T| B' s + C' p - F  what its supports exert, along the directions that they hold.
#pragma once

#include <optional>

#include "solver/model.h"
#include "solver/state.h"

namespace mortier {

/// C' p on a body (dofs) [N/m]: of all interfaces, or of those that have this label of it as a side.
Vector contactForces(const Model& model, const std::vector<Vector>& p, int body,
                     std::optional<int> label = std::nullopt);

/// Whether the label of a body is a side of the interface.
bool isSide(const ContactInterface& interface, int body, std::optional<int> label = std::nullopt);

}  // namespace mortier
