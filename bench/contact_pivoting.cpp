// Work of the contact problem in factorisations of its matrix, over random loads
// (tests/unit/load_patterns.h): operations as the solver counts them, and time against that of factorising
// the matrix once, both measured here.
// contact_pivoting [NODES] [PATTERNS] [LINES]   (default 400 nodes, 1000 patterns, the ten lines 0123456789;
//                                                  after every 100 patterns the worst so far goes to stderr)
#include <Eigen/Cholesky>
#include <Eigen/LU>
#include <cstdio>
#include <cstdlib>
#include <string>

#include "clock.h"
#include "unit/load_patterns.h"

int main(int argc, char** argv) {
  using namespace mortier;
  const int nodes = argc > 1 ? std::atoi(argv[1]) : 400;
  const int count = argc > 2 ? std::atoi(argv[2]) : 1000;
  const std::string lines = argc > 3 ? argv[3] : "0123456789";
  const char* names[] = {"half plane", "two half planes", "beam", "thin beam", "unsymmetric"};
  bench::timeOf = bench::TimeOf::processor;
  std::printf("%d nodes, %d loads each; work and time in factorisations of W\n", nodes, count);
  std::printf("%-16s %7s %8s %8s %8s %8s %8s %8s\n", "line", "motions", "mean", "worst", "time", "worst",
              "pivots", "unsolved");
  for (const char digit : lines) {
    const int motions = (digit - '0') % 2;
    const patterns::Line line = patterns::allLines[(digit - '0') / 2];
    std::mt19937 random(1);
    ContactProblem problem;
    problem.W = patterns::compliance(line, nodes);
    problem.symmetric = line != patterns::Line::unsymmetric;
    problem.G = Matrix::Ones(nodes, motions);
    const double once = bench::secondsOf([&] {
      if (problem.symmetric)
        Eigen::LLT<Matrix>(problem.W).matrixLLT()(0, 0);
      else
        Eigen::PartialPivLU<Matrix>(problem.W).matrixLU()(0, 0);
    });
    double sum = 0;
    double worst = 0;
    double time = 0;
    double longest = 0;
    int pivots = 0;
    int unsolved = 0;
    for (int i = 0; i < count; ++i) {
      const patterns::Pattern pattern = patterns::pattern(random, problem);
      ContactSolution solution;
      const double seconds = bench::secondsOf([&] {
        solution = solveContact(problem, pattern.slack, Vector::Zero(nodes), pattern.balance, pattern.active);
      });
      sum += solution.work;
      worst = std::max(worst, solution.work);
      time += seconds / once;
      longest = std::max(longest, seconds / once);
      pivots = std::max(pivots, solution.pivots);
      unsolved += solution.outcome != ContactSolution::Outcome::solved ? 1 : 0;
      if ((i + 1) % 100 == 0)
        std::fprintf(stderr, "%s %d: %d loads, mean %.2f, worst %.2f, unsolved %d\n",
                     names[static_cast<int>(line)], motions, i + 1, sum / (i + 1), worst, unsolved);
    }
    std::printf("%-16s %7d %8.2f %8.2f %8.2f %8.2f %8d %8d\n", names[static_cast<int>(line)], motions,
                sum / count, worst, time / count, longest, pivots, unsolved);
    std::fflush(stdout);
  }
  return 0;
}
