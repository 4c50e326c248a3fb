#include "linear/partition.h"

#ifdef MORTIER_METIS
#include <metis.h>
#endif

#include <algorithm>
#include <stdexcept>

#include "base/interrupt.h"
#include "linear/cholmod_common.h"

namespace mortier {
namespace {

#ifdef MORTIER_METIS

std::vector<int> byMetis(const Graph& graph, const std::vector<double>& shares) {
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
  const std::lock_guard alone(metisInUse);
  const DeafCall deaf;
  const int code =
      METIS_PartGraphRecursive(&vertices, &constraints, input.start.data(), input.neighbours.data(), nullptr,
                               nullptr, nullptr, &parts, targets.data(), nullptr, options, &cut, part.data());
  if (code != METIS_OK) throw std::runtime_error("the bodies could not be shared out by METIS");
  return part;
}

#else

std::vector<int> byRanges(const Graph& graph, const std::vector<double>& shares) {
  std::vector<int> part(graph.size());
  double end = 0;
  int vertex = 0;
  for (size_t p = 0; p < shares.size(); ++p) {
    end += shares[p] * graph.size();
    for (; vertex < graph.size() && (vertex < end || p + 1 == shares.size()); ++vertex)
      part[vertex] = static_cast<int>(p);
  }
  return part;
}

#endif

}  // namespace

std::vector<int> partition(const Graph& graph, const std::vector<double>& shares) {
  if (shares.size() < 2) return std::vector<int>(graph.size(), 0);
#ifdef MORTIER_METIS
  return byMetis(graph, shares);
#else
  return byRanges(graph, shares);
#endif
}

}  // namespace mortier
