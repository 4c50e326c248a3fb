// Forces that act on the nodes of a body at one state, beside its loads:
//   C' p + T' t  what contact and its friction take from it (it gets the opposite),
//   r = sum |T| B' s + C' p + T' t - F  what its supports exert, along the directions that they hold.
#pragma once

#include <optional>

#include "solver/model.h"
#include "solver/state.h"

namespace mortier {

/// Forces by interfaces, t only where there is friction, and by ties [N/m].
struct InterfaceForces {
  const std::vector<Vector>& p;
  const std::vector<Vector>& t;
  const std::vector<Vector>& ties;
};
inline InterfaceForces forcesOf(const State& state) {
  return {state.contactForce, state.frictionForce, state.tieForce};
}

/// C' p + T' t on a body (dofs), and the same of ties [N/m]: of all, or of those that have this label of it
/// as a side.
Vector contactForces(const Model& model, const InterfaceForces& forces, int body,
                     std::optional<int> label = std::nullopt);

/// Whether a side of a tie (Tie::sides) is the body, by this label of it.
bool isTieSide(const Tie& tie, size_t side, int body, std::optional<int> label);

/// Whether the label of a body is a side of the pair.
bool isSide(const ContactPair& pair, int body, std::optional<int> label = std::nullopt);

}  // namespace mortier
