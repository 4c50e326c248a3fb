// What a step gains from more cores: the graph of its pieces of work, taken on one thread in processor time,
// and played on 2 to 64 (docs/scaling.md). Memory that cores share is not in it.
//   task_graph [TRIANGLES ...]        default: 1e5 1e6
#include <algorithm>
#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <vector>

#include "recorded_threads.h"
#include "squares.h"
#include "time/march.h"

namespace mortier::bench {
namespace {

struct Done {};

/// The graph of a step in which both bodies flow and nothing is done for the first time.
std::vector<Piece> graphOfStep(const Cells& cells, Projection projection) {
  constexpr int warmUp = 3;
  const Model model = twoSquares(cells, projection, CouplingKind::mortar);
  State state = flowing(model);
  SolverOptions options;
  options.threads = 2;
  const TimePlan plan{flowingTime + timeStep * 2 * warmUp, 2 * warmUp, Scheme::backwardEuler};
  std::vector<Piece> graph;
  int steps = 0;
  const Observer observer = [&](const State&, const StepReport& step) {
    if (++steps == warmUp + 1) {
      graph = takeRecord();
      for (Piece& piece : graph) piece.seconds /= step.iterations;
      throw Done{};
    }
    beginRecord();
  };
  try {
    const RunReport report = march(model, state, plan, options, observer);
    std::fprintf(stderr, "task_graph: %s\n", report.reason.c_str());
    std::exit(EXIT_FAILURE);
  } catch (const Done&) {
  }
  return graph;
}

void print(const Cells& cells, Projection projection, const char* name) {
  const std::vector<Piece> graph = graphOfStep(cells, projection);
  double all = 0;
  double parallel = 0;
  for (const Piece& piece : graph) {
    all += piece.seconds;
    if (piece.parallel) parallel += piece.seconds;
  }
  const std::vector<int> chain = longestChain(graph);
  double path = 0;
  for (const int i : chain) path += graph[i].seconds;
  std::printf("%9d %-10s %8zu %9.4f %9.1f %9.4f", cells.triangles(), name, graph.size(), all,
              100 * parallel / all, path);
  for (const int processors : {2, 4, 8, 16, 64}) std::printf(" %6.2f", all / secondsOn(graph, processors));
  std::printf("\n");
  if (std::getenv("MORTIER_LONGEST_CHAIN") != nullptr)
    for (const int i : chain)
      if (graph[i].seconds > 0.001 * all)
        std::printf("  piece %d of %zu%s: %.2f %%\n", i, graph.size(), graph[i].parallel ? "" : ", alone",
                    100 * graph[i].seconds / all);
  std::fflush(stdout);
}

}  // namespace
}  // namespace mortier::bench

int main(int argc, char** argv) {
  using namespace mortier;
  using namespace mortier::bench;
  std::vector<double> sizes;
  for (int i = 1; i < argc; ++i) sizes.push_back(std::atof(argv[i]));
  if (sizes.empty()) sizes = {1e5, 1e6};
  std::printf("One Newton iteration, both bodies flowing; times of the gain over one thread\n");
  std::printf("%9s %-10s %8s %9s %9s %9s %6d %6d %6d %6d %6d\n", "triangles", "norm", "pieces", "work [s]",
              "parallel%", "path [s]", 2, 4, 8, 16, 64);
  for (const double size : sizes) {
    const auto side = static_cast<int>(std::lround(std::sqrt(size / 12)));
    const Cells cells{side, static_cast<int>(std::lround(std::sqrt(2.0) * side))};
    print(cells, Projection::frobenius, "frobenius");
    print(cells, Projection::elasticity, "elasticity");
  }
  return EXIT_SUCCESS;
}
