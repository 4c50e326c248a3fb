// The rigid motions of a body that its supports leave free.
#pragma once

#include <string>

#include "fem/body.h"

namespace mortier {

/// Columns are motions by dofs, independent, of unit size: translations and rotations of each part of the
/// mesh that is rigid in itself (mesh/element_sides.h; in space those that share no vertex), combined so that
/// nothing moves along a prescribed motion and parts stay together at hinges. None for a body that is held.
/// \throws InputError, UnheldBodyError where the mesh falls into hundreds of parts.
Matrix rigidModes(const Body& body);

/// A motion in words: "translation along (0, 1)", "rotation about (0.5, 2)", in space "rotation about the
/// line through (0, 0, 0) along z", where it is that of a part of the mesh ", of its part around (3, 1)".
std::string describeRigidMotion(const Body& body, const Vector& motion);

}  // namespace mortier
