// From a [[contact]] of a scene to an interface between two bodies of a model.
#pragma once

#include <string>
#include <vector>

#include "scene/scene.h"
#include "solver/model.h"

namespace mortier {

/// Adds the interface to the model, which has its bodies.
/// \throws InputError with file and line: a gap [m] that is not finite, sides that do not face each other.
void addContact(const SceneDescription& scene, const ContactDescription& contact, Model& model);

/// In words, with what it does: distances that are not larger than what polygons are off the curves behind
/// them. Empty where there is nothing to say.
std::string doubtOfPolygons(const ContactInterface& interface, const std::string& length);

}  // namespace mortier
