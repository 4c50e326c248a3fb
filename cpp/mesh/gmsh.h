// Meshes and geometries that Gmsh reads: .msh (2.2, 4.1), .geo, CAD files. A geometry is meshed first.
#pragma once

#include <string>

#include "mesh/read.h"

namespace mortier {

/// Whether a file is one for Gmsh, by its extension.
bool isGmshFile(const std::string& path);

/// How long Gmsh may take for a file [s]: some 1e7 triangles; on damaged CAD files it may never end.
constexpr double gmshPatience = 600;

/// Physical curves become boundary labels, physical surfaces regions, with their numbers and names; where
/// there are none, the curves or surfaces themselves, without names. \throws InputError when Gmsh cannot read
/// the file, when it is no sound plane mesh of linear triangles, when a parameter is none of the geometry's,
/// when Gmsh takes longer than `seconds`, or when this build has no Gmsh.
TriangleMesh readGmsh(const MeshSource& source, double seconds = gmshPatience);
/// The same in space: linear tetrahedra; physical surfaces become boundary labels, physical volumes regions.
TetrahedronMesh readSpaceGmsh(const MeshSource& source, double seconds = gmshPatience);

}  // namespace mortier
