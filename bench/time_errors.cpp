// How far random runs with steps chosen by their error are off (tests/theory/time_errors.h), and what they
// cost beside equal steps.
//   build/bench/time_errors FROM TO [FINE [compare|reclose]]     a line for each run, then the distribution;
//                                   with equal steps beside it, or of bodies whose contact opens and recloses
#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <string>

#include "theory/time_errors.h"

using namespace mortier;
using namespace mortier::timeerrors;

namespace {

/// Whether so many equal steps miss more of a datum than steps chosen by their error may
/// (time/controller.cpp).
bool passesOver(const Case& of, int steps) {
  const double most = 0.2 * std::sqrt(of.tolerance);
  std::vector<double> nodes;
  for (const Stage& stage : tableau(of.scheme).stages) nodes.push_back(stage.time);
  for (const Course& course : of.plan.data)
    for (int i = 0; i < steps; ++i)
      if (unseen(course, nodes, double(i) / steps, double(i + 1) / steps) > most) return true;
  return false;
}

/// Linear solves of the cheapest equal steps, 0 where they would take more than twice those of the run.
struct BestOfEqual {
  int solves = 0;
  int fairer = 0;  ///< of those that see the data, and are as exact in the friction work
};

/// In powers of sqrt(2), whose error is no larger than that of the run or one tolerance, and neither is that
/// of up to three times as many: few steps are right at their ends by chance.
BestOfEqual bestOfEqual(const Case& of, const Outcome& run, int fine) {
  constexpr size_t sure = 4;
  const double most = std::max({1.0, run.stress, run.displacement});
  const int solves = 2 * run.run.iterations;
  const auto stages = static_cast<int>(tableau(of.scheme).stages.size());
  std::vector<int> good, fairer;
  for (double steps = 2; !fairer.empty() || steps * stages < solves; steps *= std::numbers::sqrt2) {
    const TimePlan plan{.end = 1, .steps = static_cast<int>(steps), .scheme = of.scheme};
    const bool sees = !passesOver(of, plan.steps);
    if (!sees && good.size() >= sure) continue;
    const Outcome equal = outcomeOf(of, fine, plan);
    const auto count = [&](std::vector<int>& counts, bool isGood) {
      if (isGood)
        counts.push_back(equal.run.iterations);
      else if (counts.size() < sure)
        counts.clear();
    };
    const bool converged = equal.run.status == Status::converged;
    const bool exact = converged && std::max(equal.stress, equal.displacement) <= most;
    count(good, exact);
    count(fairer, exact && sees && equal.friction <= std::max(1.0, run.friction));
    if (fairer.size() >= sure) break;
  }
  const auto first = [](const std::vector<int>& counts) { return counts.size() < sure ? 0 : counts.front(); };
  return {first(good), first(fairer)};
}

}  // namespace

int main(int argc, char** argv) {
  const int from = argc > 1 ? std::atoi(argv[1]) : 0;
  const int to = argc > 2 ? std::atoi(argv[2]) : 100;
  const int fine = argc > 3 ? std::atoi(argv[3]) : 4000;
  const std::string option = argc > 4 ? argv[4] : "";
  const bool compares = option == "compare";
  std::vector<double> errors;
  std::vector<double> works;   // over the cheapest equal steps
  std::vector<double> fairer;  // that see the data, and are as exact in the friction work
  int told = 0;
  int failed = 0;
  for (int seed = from; seed < to; ++seed) {
    const Case of = randomCase(seed, option == "reclose");
    const Outcome run = outcomeOf(of, fine, of.plan);
    const double error = std::max(run.stress, run.displacement);
    const bool says = run.run.timeError > of.tolerance;
    BestOfEqual best;
    if (run.run.status != Status::converged)
      ++failed;
    else if (says)
      ++told;
    else {
      errors.push_back(error);
      if (compares) {
        best = bestOfEqual(of, run, fine / 4);
        const auto over = [&](int found) { return found > 0 ? double(run.run.iterations) / found : 0.5; };
        works.push_back(over(best.solves));
        fairer.push_back(over(best.fairer));
      }
    }
    std::printf(
        "%4d error %8.3g %8.3g at %.5f  work %8.3g  estimate %8.3g  tol %.0e  %5d steps %6d solves "
        "(%d before) %4d rejected best %d %d  %s%s%s\n",
        seed, run.stress, run.displacement, run.at, run.friction, run.run.timeError / of.tolerance,
        of.tolerance, run.run.steps, run.run.iterations, run.run.pilotIterations, run.run.rejected,
        best.solves, best.fairer, of.name.c_str(),
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
  if (compares)
    std::printf(
        "linear solves over those of equal steps at most 2 in %.1f %%; where these see the data and are "
        "as exact in the friction work in %.1f %%\n",
        within(works, 2), within(fairer, 2));
  return 0;
}
