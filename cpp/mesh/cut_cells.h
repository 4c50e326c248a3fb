// Quadrangles, hexahedra, prisms and pyramids as triangles and tetrahedra, without new vertices.
#pragma once

#include <array>
#include <span>
#include <string>
#include <vector>

namespace mortier {

// The diagonal of every quadrangle, also of one that is the side of a cell in space, begins at the smallest
// of its vertex numbers: neighbours agree. A cell in space is cut from its smallest vertex, from which all
// diagonals of the sides there begin (Dompierre et al. 1999). Cells may be collapsed, i.e. have a vertex
// twice: what has no volume is left out.

/// \param cell  vertices of a triangle or a quadrangle, around it
void cutCell(std::span<const int> cell, std::vector<std::array<int, 3>>& triangles);

/// \param cell  vertices of a tetrahedron, a pyramid (apex last), a prism or a hexahedron (one end around it,
/// then the other); tetrahedra may be turned over
void cutCell(std::span<const int> cell, std::vector<std::array<int, 4>>& tetrahedra);

/// What a reader made of the cells of a file.
struct ChangedCells {
  bool cut = false;        ///< some had more vertices than a simplex
  bool quadratic = false;  ///< some had nodes on their edges

  /// One line; empty where nothing was changed. \param simplices  "triangles" or "tetrahedra"
  [[nodiscard]] std::string text(const std::string& simplices) const;
};

}  // namespace mortier
