// --set key=value: changes a scene before it is validated.
#pragma once

#include <string>

#include "scene/document.h"

namespace mortier {

/// Sets `path=value` in the document. Where the path meets an array of tables its next component is the name
/// of an element (or the label, in body.boundary), or its index from 0, or is left out, which means every
/// element:
///   time.steps=20   contact.variant=interpolation   body.upper.mesh=a.mesh
///   body.material.projection=frobenius
/// \throws InputError that quotes what exists.
void applyOverride(Node& document, const std::string& setting);

}  // namespace mortier
