// How well a tolerance is met, how well the error in time is known, and what that costs beside equal steps:
//   time_control [part of a row's name] [--fine] [--quick]
// `equal` is the work of the cheapest run with equal steps of the same scheme that is as accurate; 0 where
// none takes less than the run.
// Truth: for mortar, where the stress is uniform and given, an integral in time; for interpolation a run with
// very short steps. The error of a run is the largest of any step, of displacement (mean) and stress (energy
// norm), each over the largest of the run.
#include <cstdio>
#include <cstring>
#include <string>

#include "theory/time_cases.h"

namespace {

using namespace mortier;
using namespace mortier::timecases;

struct Count {
  int runs = 0, told = 0, met = 0, tripled = 0, exact = 0, known = 0, rated = 0, cheap = 0;

  void add(const Outcome& run, double tolerance, int best, bool rate) {
    // Neither the error nor the estimate is anything beside the tolerance: their ratio says nothing.
    constexpr double nothing = 1e-3;
    ++runs;
    const double error = run.error / tolerance;
    met += error <= 1.5 || run.told ? 1 : 0;
    tripled += error <= 3 || run.told ? 1 : 0;
    told += run.told ? 1 : 0;
    const double effectivity = run.estimate / run.error;
    if (std::max(run.error, run.estimate) <= nothing * tolerance)
      ++exact;
    else
      known += (effectivity >= 0.3 && effectivity <= 3) || run.told ? 1 : 0;
    rated += rate ? 1 : 0;
    cheap += rate && (best == 0 || run.solves <= 2 * best) ? 1 : 0;
  }
  void print(const char* what) const {
    const auto share = [&](int n, int of) { return of > 0 ? 100.0 * n / of : 100.0; };
    std::printf(
        "%-16s %4d runs: error <= 1.5 tol %5.1f %%, <= 3 tol %5.1f %%, estimate within 0.3..3 %5.1f %% "
        "(without %d whose error and estimate are below 1e-3 tol), work <= 2 x equal steps %5.1f %%, told "
        "%d\n",
        what, runs, share(met, runs), share(tripled, runs), share(known, runs - exact), exact,
        share(cheap, rated), told);
  }
};

}  // namespace

int main(int argc, char** argv) {
  std::string part;
  Size size = Size::small;
  bool quick = false;
  for (int i = 1; i < argc; ++i) {
    if (std::strcmp(argv[i], "--fine") == 0)
      size = Size::note;
    else if (std::strcmp(argv[i], "--quick") == 0)
      quick = true;
    else
      part = argv[i];
  }
  std::printf("%-52s %8s %6s %5s %6s %9s %8s %8s %6s %6s\n", "case", "tol", "steps", "rej", "solves", "error",
              "err/tol", "est/err", "equal", "ratio");
  Count all;
  Count of[2];
  for (const Case& each : cases(size)) {
    if (each.name.find(part) == std::string::npos) continue;
    const Truth truth(each);
    std::map<int, Outcome> equal;
    for (const double tolerance : each.tolerances) {
      const Outcome run = controlledRun(each, truth, tolerance);
      const int best =
          quick ? 0 : bestOfEqual(each, truth, std::max(run.error, 1e-3 * tolerance), run.solves, equal);
      std::printf("%-52s %8.0e %6d %5d %6d %9.2e %8.2f %8.2f %6d %6.2f%s%s\n", each.name.c_str(), tolerance,
                  run.steps, run.rejected, run.solves, run.error, run.error / tolerance,
                  run.estimate / run.error, best, best > 0 ? 1.0 * run.solves / best : 0,
                  run.told ? "  told" : "", run.reason.empty() ? "" : ("  " + run.reason).c_str());
      std::fflush(stdout);
      all.add(run, tolerance, best, !quick);
      of[each.scheme == Scheme::sdirk2 ? 0 : 1].add(run, tolerance, best, !quick);
    }
  }
  of[0].print("sdirk2");
  of[1].print("backward-euler");
  all.print("all");
}
