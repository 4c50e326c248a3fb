#ifdef MORTIER_GMSH
#include "mesh/gmsh_cells.h"

#include <gmshc.h>

namespace mortier {

std::vector<size_t> elements(const Gmsh& gmsh, int type, int entity) {
  Gmsh::Array<size_t> tags;
  Gmsh::Array<size_t> nodes;
  gmsh.call<decltype(gmshModelMeshGetElementsByType)>("gmshModelMeshGetElementsByType", type, &tags.data,
                                                      &tags.size, &nodes.data, &nodes.size, entity, size_t{0},
                                                      size_t{1});
  gmsh.take(tags);
  return gmsh.take(nodes);
}

std::vector<int> elementTypes(const Gmsh& gmsh, int dimension) {
  Gmsh::Array<int> types;
  gmsh.call<decltype(gmshModelMeshGetElementTypes)>("gmshModelMeshGetElementTypes", &types.data, &types.size,
                                                    dimension, -1);
  return gmsh.take(types);
}

}  // namespace mortier

#endif
