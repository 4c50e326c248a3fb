// The rigid motions of a body that its supports leave free.
#pragma once

#include <string>

#include "fem/body.h"

namespace mortier {

/// Columns are motions by dofs, independent, of unit size over the body: translations and the rotation about
/// its centre, combined so that nothing moves along a prescribed motion. None for a body that is held.
Matrix rigidModes(const Body& body);

/// A motion in words: "translation along (0, 1)", "rotation about (0.5, 2)".
std::string describeRigidMotion(const Body& body, const Vector& motion);

}  // namespace mortier
