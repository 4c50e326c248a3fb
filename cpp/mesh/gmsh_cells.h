// Cells of the entities of Gmsh.
#pragma once

#include <algorithm>
#include <iterator>
#include <string>
#include <vector>

#include "base/error.h"
#include "mesh/gmsh_library.h"

namespace mortier {

/// Node tags of the elements of one type on an entity.
std::vector<size_t> elements(const Gmsh& gmsh, int type, int entity);
std::vector<int> elementTypes(const Gmsh& gmsh, int dimension);

/// Cells of Gmsh up to degree 2; their corners are the first of their nodes.
struct CellType {
  int type;
  size_t nodes, corners;
  bool quadratic;
};
inline constexpr CellType cellTypes[] = {
    {1, 2, 2, false},  {2, 3, 3, false},  {3, 4, 4, false},  {4, 4, 4, false},  {5, 8, 8, false},
    {6, 6, 6, false},  {7, 5, 5, false},  {8, 3, 2, true},   {9, 6, 3, true},   {10, 9, 4, true},
    {11, 10, 4, true}, {12, 27, 8, true}, {13, 18, 6, true}, {14, 14, 5, true}, {16, 8, 4, true},
    {17, 20, 8, true}, {18, 15, 6, true}, {19, 13, 5, true}};

/// Node tags of the corners of all cells of a dimension on an entity: use(type, corners).
template <class Use>
void forCornersOn(const Gmsh& gmsh, int dimension, int entity, const Use& use) {
  for (const int type : elementTypes(gmsh, dimension)) {
    const auto* const known = std::find_if(std::begin(cellTypes), std::end(cellTypes),
                                           [&](const CellType& each) { return each.type == type; });
    if (known == std::end(cellTypes))
      throw InputError(gmsh.path() + ": elements of Gmsh's type " + std::to_string(type) +
                       ", expected linear or quadratic triangles, quadrangles, tetrahedra, hexahedra, prisms "
                       "or pyramids");
    const std::vector<size_t> nodes = elements(gmsh, type, entity);
    std::vector<size_t> corners;
    for (size_t i = 0; i + known->nodes <= nodes.size(); i += known->nodes)
      for (size_t k = 0; k < known->corners; ++k) corners.push_back(nodes[i + k]);
    use(*known, corners);
  }
}

}  // namespace mortier
