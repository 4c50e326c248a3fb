#include "mesh/read.h"

#include "base/error.h"
#include "mesh/gmsh.h"
#include "mesh/medit.h"

namespace mortier {

TriangleMesh readMesh(const MeshSource& source) {
  if (source.shape) return shapeMesh(*source.shape);
  if (isGmshFile(source.path)) return readGmsh(source);
  if (source.size > 0 || !source.parameters.empty())
    throw InputError(source.path + ": size or parameters, expected only for a geometry that Gmsh meshes");
  return readMedit(source.path, source.regions);
}

}  // namespace mortier
