// Forces that act on the nodes of a body at one state, beside its loads:
//   C' p + T' t  what contact and its friction take from it (it gets the opposite),
//   r = sum |T| B' s + C' p + T' t - F  what its supports exert, along the directions that they hold.
#pragma once

#include <optional>

#include "solver/model.h"
#include "solver/state.h"

namespace mortier {

/// C' p + T' t on a body (dofs) [N/m]: of all interfaces, or of those that have this label of it as a side.
/// \param p, t  by interfaces; t only where there is friction.
Vector contactForces(const Model& model, const std::vector<Vector>& p, const std::vector<Vector>& t, int body,
                     std::optional<int> label = std::nullopt);

/// Whether the label of a body is a side of the interface.
bool isSide(const ContactInterface& interface, int body, std::optional<int> label = std::nullopt);

}  // namespace mortier
