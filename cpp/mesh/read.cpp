#include "mesh/read.h"

#include "mesh/gmsh.h"
#include "mesh/medit.h"

namespace mortier {

TriangleMesh readMesh(const std::string& path) {
  return isGmshFile(path) ? readGmsh(path) : readMedit(path);
}

}  // namespace mortier
