// Numbers with a unit in a scene, young = "210 GPa", as numbers of the scene's units.
#pragma once

#include "base/units.h"
#include "scene/document.h"

namespace mortier {

/// The units that a scene says. \throws InputError
Units readUnits(const Node& scene);

/// Makes numbers of the scene's units of all numbers with a unit.
/// \throws InputError with its place where a unit is not known, of another dimension, or the scene says none.
void convertMeasures(Node& scene, const Units& units);

}  // namespace mortier
