// The constants that a geometry of Gmsh declares: DefineConstant[ name = value, ... ].
#pragma once

#include "mesh/read.h"

namespace mortier {

/// Gmsh overlooks a number that no constant of the geometry takes.
/// \throws InputError when a parameter is none of them.
void requireConstants(const MeshSource& source);

}  // namespace mortier
