// Graphs cut by METIS (Karypis and Kumar 1998).
#pragma once

#include "linear/partition.h"

namespace mortier {

/// \throws std::runtime_error
std::vector<int> partitionByMetis(const Graph& graph, const std::vector<double>& shares);

}  // namespace mortier
