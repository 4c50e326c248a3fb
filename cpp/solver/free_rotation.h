// Rollers: bodies whose contact nodes lie on circles about one centre. Frictionless contact does not resist a
// rotation about this centre, even if the discretised conditions at nodes near a flat side seem to, and the
// rest of the solution does not depend on it.
#pragma once

#include <optional>

#include "solver/model.h"

namespace mortier {

/// The centre of the circles; none where the contact nodes of the body are on none, or where there is
/// friction.
std::optional<Point> centreOfRoller(const Model& model, int body);

/// The same where the supports leave the rotation about it free, too.
std::optional<Point> freeRotation(const Model& model, int body);

/// Whether a rigid motion (by dofs) is such a rotation, but for its displacements of nodes.
bool turnsInItself(const Model& model, int body, const Vector& motion);

}  // namespace mortier
