// Meshes of tetrahedra from those of triangles in the plane z = 0: moved along z, or turned about the axis
// x = 0, layer by layer.
#pragma once

#include "mesh/tetrahedron_mesh.h"
#include "mesh/triangle_mesh.h"

namespace mortier {

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

}  // namespace mortier
