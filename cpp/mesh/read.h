#pragma once

#include <map>
#include <optional>
#include <string>
#include <vector>

#include "mesh/shape.h"
#include "mesh/space_shapes.h"
#include "mesh/tetrahedron_mesh.h"
#include "mesh/triangle_mesh.h"

namespace mortier {

// Meshes of tetrahedra from those of triangles in the plane z = 0: moved along z, or turned about the axis
// x = 0, layer by layer.

struct Sweep {
  double length = 0;  ///< along z [m]; 0: the mesh turns
  double angle = 0;   ///< from the x axis towards the z axis [rad]; 2 pi to 1e-6: all the way
  int layers = 1;
};

/// In each layer a triangle becomes a prism, which is cut into three tetrahedra, or into fewer where it
/// touches the axis. Sides keep their labels and regions; the planes where the sweep begins and ends, if it
/// is not closed, have the two labels after the largest one, named "start" and "end". \throws InputError
/// where a vertex is on the wrong side of the axis, or layers turn by half a circle.
TetrahedronMesh sweptMesh(TriangleMesh plane, const Sweep& sweep);

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
