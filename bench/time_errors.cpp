// How far random runs with steps chosen by their error are off (tests/theory/time_errors.h), and what they
// cost beside equal steps.
//   build/bench/time_errors FROM TO [FINE]     a line for each run, then the distribution
#include <cstdio>
#include <cstdlib>

#include "theory/time_errors.h"

using namespace mortier;
using namespace mortier::timeerrors;

namespace {

/// Linear solves of the cheapest equal steps, in powers of sqrt(2), whose error is no larger than `most`
/// tolerances, and neither is that of up to three times as many: few steps pass over what data do between
/// them, and are right at their ends by chance. 0 where they would take more than `solves`.
int bestOfEqual(const Case& of, double most, int solves, int fine) {
  constexpr int sure = 4;
  const auto stages = static_cast<int>(tableau(of.scheme).stages.size());
  std::vector<int> good;
  for (double steps = 2; !good.empty() || steps * stages < solves; steps *= std::numbers::sqrt2) {
    const TimePlan plan{.end = 1, .steps = static_cast<int>(steps), .scheme = of.scheme};
    const Outcome equal = outcomeOf(of, fine, plan);
    if (equal.run.status == Status::converged && std::max(equal.stress, equal.displacement) <= most)
      good.push_back(equal.run.iterations);
    else
      good.clear();
    if (good.size() == sure) return good.front();
  }
  return 0;
}

}  // namespace

int main(int argc, char** argv) {
  const int from = argc > 1 ? std::atoi(argv[1]) : 0;
  const int to = argc > 2 ? std::atoi(argv[2]) : 100;
  const int fine = argc > 3 ? std::atoi(argv[3]) : 4000;
  const bool compares = argc > 4;
  std::vector<double> errors;
  std::vector<double> works;
  int told = 0;
  int failed = 0;
  for (int seed = from; seed < to; ++seed) {
    const Case of = randomCase(seed);
    const Outcome run = outcomeOf(of, fine, of.plan);
    const double error = std::max(run.stress, run.displacement);
    const bool says = run.run.timeError > of.tolerance;
    int best = 0;
    if (run.run.status != Status::converged)
      ++failed;
    else if (says)
      ++told;
    else {
      errors.push_back(error);
      if (compares) best = bestOfEqual(of, std::max(1.0, error), 2 * run.run.iterations, fine / 4);
      if (best > 0) works.push_back(static_cast<double>(run.run.iterations) / best);
      if (compares && best == 0) works.push_back(0.5);
    }
    std::printf(
        "%4d error %8.3g %8.3g at %.5f  estimate %8.3g  tol %.0e  %5d steps %6d solves (%d before) %4d "
        "rejected best %d  %s%s%s\n",
        seed, run.stress, run.displacement, run.at, run.run.timeError / of.tolerance, of.tolerance,
        run.run.steps, run.run.iterations, run.run.pilotIterations, run.run.rejected, best, of.name.c_str(),
        says          ? "  TOLD"
        : error > 1.5 ? "  OFF"
                      : "",
        run.run.status != Status::converged ? (" FAILED " + run.run.reason).c_str() : "");
    std::fflush(stdout);
  }
  std::sort(errors.begin(), errors.end());
  std::sort(works.begin(), works.end());
  const auto within = [](const std::vector<double>& of, double most) {
    return 100.0 * static_cast<double>(std::upper_bound(of.begin(), of.end(), most) - of.begin()) /
           std::max<double>(1, static_cast<double>(of.size()));
  };
  std::printf("%zu runs: within 1.5 tolerances %.1f %%, within 3 %.1f %%, largest %.3g; %d told, %d failed\n",
              errors.size(), within(errors, 1.5), within(errors, 3), errors.empty() ? 0 : errors.back(), told,
              failed);
  if (compares) std::printf("work over equal steps at most 2 in %.1f %%\n", within(works, 2));
  return 0;
}
