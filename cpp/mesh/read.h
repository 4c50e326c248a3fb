#pragma once

#include <map>
#include <optional>
#include <string>
#include <vector>

#include "mesh/shape.h"
#include "mesh/space_shapes.h"
#include "mesh/swept_mesh.h"

namespace mortier {

/// Where the mesh of a body comes from.
struct MeshSource {
  std::string path;                        ///< as the program opens it; of a shape, its word
  std::optional<MeshShape> shape = {};     ///< in place of a file
  std::optional<SpaceShape> inSpace = {};  ///< the same in space
  std::optional<Sweep> sweep = {};         ///< of a plane mesh to one in space
  std::vector<std::string> regions = {};   ///< names or numbers of those that are the body; none: all
  double size = 0;  ///< longest edge where Gmsh meshes a geometry [m]; 0: the geometry's own
  std::map<std::string, double> parameters = {};  ///< of a .geo, which names them in DefineConstant
};

/// A shape, or a mesh file of any kind that is known: Medit by ourselves, others by Gmsh. \throws InputError
TriangleMesh readMesh(const MeshSource& source);
TetrahedronMesh readSpaceMesh(const MeshSource& source);

}  // namespace mortier
