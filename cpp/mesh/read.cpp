#include "mesh/read.h"

#include "base/error.h"
#include "mesh/gmsh.h"
#include "mesh/medit.h"

namespace mortier {
namespace {

void requireNoGeometry(const MeshSource& source) {
  if (source.size > 0 || !source.parameters.empty())
    throw InputError(source.path + ": size or parameters, expected only for a geometry that Gmsh meshes");
}

}  // namespace

TriangleMesh readMesh(const MeshSource& source) {
  if (source.shape) return shapeMesh(*source.shape);
  if (isGmshFile(source.path)) return readGmsh(source);
  requireNoGeometry(source);
  return readMedit(source.path, source.regions);
}

TetrahedronMesh readSpaceMesh(const MeshSource& source) {
  if (source.sweep) return sweptMesh(readMesh(source), *source.sweep);
  if (source.inSpace) return shapeMesh(*source.inSpace);
  if (isGmshFile(source.path)) return readSpaceGmsh(source);
  requireNoGeometry(source);
  return readSpaceMedit(source.path, source.regions);
}

}  // namespace mortier
