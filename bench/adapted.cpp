// What an accuracy costs on meshes that are refined for it, where the exact error is known:
//   adapted [least accuracy]
// True error over what was asked, estimate over true error, work of all rounds over that of the last one
// (unknowns to the power 1.2), and the order of the true error in unknowns.
#include <cstdio>
#include <cstdlib>

#include "theory/adapted.h"

namespace {

using namespace mortier;
using namespace mortier::scenes;

void row(const char* name, const KnownProblem& problem, double least) {
  std::vector<double> unknowns;
  std::vector<double> errors;
  for (const double accuracy : {0.1, 0.05, 0.02, 0.01, 3e-3, 1e-3, 3e-4, 1e-4}) {
    if (accuracy < 0.999 * least || (problem.degree == 1 && accuracy < (problem.inSpace() ? 0.1 : 0.01)))
      break;
    const Adapted adapted = adapt(problem, accuracy);
    unknowns.push_back(adapted.last().unknowns);
    errors.push_back(adapted.last().error);
    std::printf("%-34s %6d %9.1e %7zu %9d %12.3g %11.2f %9.2f%s\n", name, problem.degree, accuracy,
                adapted.rounds.size(), adapted.last().unknowns, adapted.last().error / accuracy,
                adapted.effectivity(), adapted.overhead(),
                adapted.verdict == Rounds::Verdict::reached ? "" : "  not reached");
    std::fflush(stdout);
  }
  std::printf("%-34s %6d  order %.2f\n", name, problem.degree, fittedOrder(unknowns, errors));
}

}  // namespace

int main(int argc, char** argv) {
  const double least = argc > 1 ? std::strtod(argv[1], nullptr) : 0.01;
  std::printf("%-34s %6s %9s %7s %9s %12s %11s %9s\n", "", "degree", "accuracy", "rounds", "unknowns",
              "error/asked", "effectivity", "overhead");
  for (const int degree : {1, 2}) row("end of contact, in space", halfOpenInSpace(6, degree), least);
  row("L", lShape(1, 1), least);
  row("L", lShape(1, 2), least);
  for (const double contrast : {1.0, 1e3, 1e6})
    for (const int nonmortar : {upperBody, lowerBody}) {
      const std::string name = "end of contact, E 1:" + std::to_string(static_cast<int>(contrast)) +
                               (nonmortar == upperBody ? "" : ", swapped");
      for (const int degree : {1, 2}) row(name.c_str(), halfOpen({4, 5}, contrast, nonmortar, degree), least);
    }
  return 0;
}
