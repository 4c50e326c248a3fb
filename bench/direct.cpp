// Our factorisation of a symmetric matrix of a file (bench/multigrid.py writes it): processor time of the
// analysis, of a factorisation and of a solve, and the residual over the right-hand side.
//   direct FILE [ROUNDS]
// FILE: int32 size, int32 entries of the lower triangle by columns; int32 columnStart[size + 1],
// int32 rows[entries], double values[entries], double rhs[size].
#include <algorithm>
#include <cstdint>
#include <cstdio>
#include <cstdlib>
#include <fstream>

#include "base/parallel.h"
#include "clock.h"
#include "linear/condensing_solver.h"

int main(int argc, char** argv) {
  using namespace mortier;
  using bench::now;
  bench::timeOf = bench::TimeOf::processor;
  std::ifstream file(argc > 1 ? argv[1] : "", std::ios::binary);
  const auto read = [&](auto& vector) {
    file.read(reinterpret_cast<char*>(vector.data()),
              static_cast<std::streamsize>(vector.size() * sizeof(vector[0])));
  };
  std::vector<std::int32_t> sizes(2);
  read(sizes);
  if (!file) {
    std::fprintf(stderr, "direct: a file of a matrix is expected\n");
    return EXIT_FAILURE;
  }
  SparsePattern pattern;
  pattern.size = sizes[0];
  pattern.columnStart.resize(pattern.size + 1);
  pattern.rows.resize(sizes[1]);
  std::vector<double> values(sizes[1]);
  Vector rhs(pattern.size);
  read(pattern.columnStart);
  read(pattern.rows);
  read(values);
  read(rhs);
  const int rounds = argc > 2 ? std::atoi(argv[2]) : 3;
  double analysis = now();
  const auto solver = multifrontalSolver(pattern, {});
  analysis = now() - analysis;
  double factor = INFINITY;
  double solve = INFINITY;
  Vector x;
  for (int round = 0; round < rounds; ++round) {
    const double begin = now();
    if (!solver->factorise(values)) return EXIT_FAILURE;
    const double middle = now();
    x = rhs;
    solver->condense(x);
    solver->expand(x);
    factor = std::min(factor, middle - begin);
    solve = std::min(solve, now() - middle);
  }
  Vector residual = rhs;
  for (int j = 0; j < pattern.size; ++j)
    for (int k = pattern.columnStart[j]; k < pattern.columnStart[j + 1]; ++k) {
      const int i = pattern.rows[k];
      residual[i] -= values[k] * x[j];
      if (i != j) residual[j] -= values[k] * x[i];
    }
  std::printf("%.9g %.9g %.9g %.3g\n", analysis, factor, solve, residual.norm() / rhs.norm());
}
