// A graph cut into parts of given sizes.
#pragma once

#include <vector>

namespace mortier {

/// Neighbours of vertex i: [start[i], start[i + 1]).
struct Graph {
  std::vector<int> start{0};
  std::vector<int> neighbours;
  [[nodiscard]] int size() const { return static_cast<int>(start.size()) - 1; }
};

using Partitioner = std::vector<int> (*)(const Graph& graph, const std::vector<double>& shares);

/// \param shares  of the vertices that each part is to have, sum 1, none 0
/// \returns the part of every vertex: ranges of vertices, unless another way is to be used
std::vector<int> partition(const Graph& graph, const std::vector<double>& shares);
void partitionBy(Partitioner way);

}  // namespace mortier
