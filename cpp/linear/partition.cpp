#include "linear/partition.h"

#include <cstddef>

namespace mortier {
namespace {

std::vector<int> byRanges(const Graph& graph, const std::vector<double>& shares) {
  std::vector<int> part(graph.size());
  double end = 0;
  int vertex = 0;
  for (std::size_t p = 0; p < shares.size(); ++p) {
    end += shares[p] * graph.size();
    for (; vertex < graph.size() && (vertex < end || p + 1 == shares.size()); ++vertex)
      part[vertex] = static_cast<int>(p);
  }
  return part;
}

Partitioner inUse = byRanges;

}  // namespace

void partitionBy(Partitioner way) {
  inUse = way;
}

std::vector<int> partition(const Graph& graph, const std::vector<double>& shares) {
  return inUse(graph, shares);
}

}  // namespace mortier
