#include "mesh/cut_cells.h"

#include <algorithm>

namespace mortier {
namespace {

template <size_t n>
bool hasVertexTwice(std::array<int, n> vertices) {
  std::sort(vertices.begin(), vertices.end());
  return std::adjacent_find(vertices.begin(), vertices.end()) != vertices.end();
}

using Sides = std::vector<std::vector<int>>;

/// Places of the vertices of each side in a cell.
const Sides& sidesOf(size_t corners) {
  static const Sides tetrahedron{{0, 1, 2}, {0, 1, 3}, {1, 2, 3}, {0, 2, 3}};
  static const Sides pyramid{{0, 1, 2, 3}, {0, 1, 4}, {1, 2, 4}, {2, 3, 4}, {3, 0, 4}};
  static const Sides prism{{0, 1, 2}, {3, 4, 5}, {0, 1, 4, 3}, {1, 2, 5, 4}, {2, 0, 3, 5}};
  static const Sides hexahedron{{0, 1, 2, 3}, {4, 5, 6, 7}, {0, 1, 5, 4},
                                {1, 2, 6, 5}, {2, 3, 7, 6}, {3, 0, 4, 7}};
  return corners == 4 ? tetrahedron : corners == 5 ? pyramid : corners == 6 ? prism : hexahedron;
}

}  // namespace

void cutCell(std::span<const int> cell, std::vector<std::array<int, 3>>& triangles) {
  const size_t n = cell.size();
  const auto smallest = std::min_element(cell.begin(), cell.end());
  const size_t first = n == 3 ? 0 : static_cast<size_t>(smallest - cell.begin());
  for (size_t k = 1; k + 1 < n; ++k) {
    const std::array<int, 3> triangle{cell[first], cell[(first + k) % n], cell[(first + k + 1) % n]};
    if (n == 3 || !hasVertexTwice(triangle)) triangles.push_back(triangle);
  }
}

void cutCell(std::span<const int> cell, std::vector<std::array<int, 4>>& tetrahedra) {
  if (cell.size() == 4) {
    tetrahedra.push_back({cell[0], cell[1], cell[2], cell[3]});
    return;
  }
  const int apex = *std::min_element(cell.begin(), cell.end());
  std::vector<std::array<int, 3>> triangles;
  for (const std::vector<int>& side : sidesOf(cell.size())) {
    std::vector<int> around;
    for (const int place : side) around.push_back(cell[static_cast<size_t>(place)]);
    cutCell(around, triangles);
  }
  for (const auto& [a, b, c] : triangles)
    if (!hasVertexTwice(std::array{apex, a, b, c})) tetrahedra.push_back({apex, a, b, c});
}

std::string ChangedCells::text(const std::string& simplices) const {
  std::string said;
  if (cut) said = "cells with more corners are cut into " + simplices;
  if (quadratic)
    said += (said.empty() ? "" : ", and ") + std::string("nodes on edges are left out: edges are straight");
  return said;
}

}  // namespace mortier
