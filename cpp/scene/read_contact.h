// One [[contact]] of a scene: its two sides, the coupling, the initial gap.
#pragma once

#include "scene/document.h"
#include "scene/scene.h"

namespace mortier {

/// `scene` holds the bodies and the contacts that were read before.
/// \throws InputError with one line `file:line: contact: key = value, expected ...`.
ContactDescription readContact(const Node& node, const SceneDescription& scene);

}  // namespace mortier
