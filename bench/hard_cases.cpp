// One row for each hard case, and what the rungs cost in all: hard_cases [part of a name] [--fast]
#include <cstdio>
#include <cstring>
#include <string>

#include "theory/hard_cases.h"

int main(int argc, char** argv) {
  using namespace mortier;
  std::string part;
  bool fast = false;
  for (int i = 1; i < argc; ++i) {
    if (std::strcmp(argv[i], "--fast") == 0)
      fast = true;
    else
      part = argv[i];
  }
  std::printf("%-78s %-9s %-12s %5s %5s %8s %8s %8s %8s %8s\n", "case", "status", "rung", "iter", "worst",
              "balance", "material", "gap", "compl", "s");
  int missed = 0;
  hardcases::RungCosts costs;
  for (const hardcases::HardCase& hard : hardcases::hardCases()) {
    if (hard.name.find(part) == std::string::npos || (fast && hard.slow)) continue;
    const hardcases::HardResult result = hardcases::solve(hard.model(), hard.plan);
    const RunReport& report = result.report;
    const char* status = report.status == Status::converged ? "converged"
                         : report.status == Status::unheld  ? "unheld"
                                                            : "failed";
    std::printf("%-78s %-9s %-12s %5d %5d %8.1e %8.1e %8.1e %8.1e %8.3f%s\n", hard.name.c_str(), status,
                nameOf(result.method()), report.iterations, report.maxIterationsInAStep,
                report.worst.forceBalance, report.worst.materialResidual, report.worst.gapOnActive,
                report.worst.complementarity, result.seconds,
                result.meetsLimits() ? "" : "  <-- limits not met");
    if (!report.reason.empty()) std::printf("    %s\n", report.reason.c_str());
    std::fflush(stdout);
    missed += result.meetsLimits() ? 0 : 1;
    for (const auto& [method, cost] : result.costs) costs[method].add(cost);
  }
  std::printf("\n%-16s %8s %14s %10s %8s\n", "rung", "steps", "linear solves", "a step", "most");
  for (const auto& [method, cost] : costs)
    std::printf("%-16s %8d %14d %10.1f %8d\n", nameOf(method), cost.steps, cost.iterations,
                static_cast<double>(cost.iterations) / cost.steps, cost.most);
  std::printf("%d cases beyond the limits\n", missed);
}
