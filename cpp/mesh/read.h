#pragma once

#include <string>

#include "mesh/triangle_mesh.h"

namespace mortier {

/// A mesh file of any kind that is known: Medit by ourselves, others by Gmsh. \throws InputError
TriangleMesh readMesh(const std::string& path);

}  // namespace mortier
