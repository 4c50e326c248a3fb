// A graph cut into parts of given sizes with few edges between them (Karypis and Kumar 1998).
#pragma once

#include <vector>

namespace mortier {

/// Neighbours of vertex i: [start[i], start[i + 1]).
struct Graph {
  std::vector<int> start{0};
  std::vector<int> neighbours;
  [[nodiscard]] int size() const { return static_cast<int>(start.size()) - 1; }
};

/// \param shares  of the vertices that each part is to have, sum 1, none 0
/// \returns the part of every vertex: by METIS, or ranges of vertices where it was not there to build with
std::vector<int> partition(const Graph& graph, const std::vector<double>& shares);

}  // namespace mortier
