#include "ranks/mpi_ranks.h"

#include <metis.h>

#include <stdexcept>

#include "base/interrupt.h"

namespace mortier {

std::vector<int> partitionByMetis(const Graph& graph, const std::vector<double>& shares) {
  static_assert(sizeof(idx_t) == sizeof(int), "METIS of the same integers");
  Graph input = graph;
  idx_t vertices = graph.size();
  idx_t constraints = 1;
  auto parts = static_cast<idx_t>(shares.size());
  std::vector<real_t> targets(shares.begin(), shares.end());
  idx_t options[METIS_NOPTIONS];
  METIS_SetDefaultOptions(options);
  options[METIS_OPTION_SEED] = 1;
  idx_t cut = 0;
  std::vector<int> part(vertices);
  const UninterruptibleCall deaf;
  const int code =
      METIS_PartGraphRecursive(&vertices, &constraints, input.start.data(), input.neighbours.data(), nullptr,
                               nullptr, nullptr, &parts, targets.data(), nullptr, options, &cut, part.data());
  if (code != METIS_OK) throw std::runtime_error("the bodies could not be shared out by METIS");
  return part;
}

}  // namespace mortier
