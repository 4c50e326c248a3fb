// What the factor of a skeleton costs: a square cut into equal parts, their inner edges the skeleton, the
// nodes of its lowest edge kept.
//   mpirun -n P build/bench/skeletons replicated|mumps PX PY NODES   P = PX PY parts of NODES nodes a side
//   mpirun -n P build/bench/skeletons predict PX PY NODES            PX PY parts shared out among any P
#include <dmumps_c.h>
#include <sys/resource.h>

#include <algorithm>
#include <cstdio>
#include <cstdlib>
#include <cstring>
#include <random>
#include <string>
#include <vector>

#include "ranks/mpi_ranks.h"

using namespace mortier;

namespace {

struct Square {
  int width;  ///< parts
  int height;
  int nodes;  ///< of a part, a side
  std::vector<int> number;
  int size = 0;
  int kept = 0;

  Square(int w, int h, int n) : width(w), height(h), nodes(n) {
    number.assign((width * nodes + 1) * (height * nodes + 1), -1);
    for (const bool keeps : {false, true})
      for (int y = 0; y <= height * nodes; ++y)
        for (int x = 0; x <= width * nodes; ++x) {
          const bool inner = (x % nodes == 0 && x > 0 && x < width * nodes) ||
                             (y % nodes == 0 && y > 0 && y < height * nodes);
          if ((y == 0) != keeps || !(inner || y == 0)) continue;
          at(x, y) = size;
          size += 2;
          if (keeps) kept += 2;
        }
  }
  int& at(int x, int y) { return number[(width * nodes + 1) * y + x]; }

  std::vector<int> equationsOf(int part) {
    const int left = part % width * nodes;
    const int bottom = part / width * nodes;
    std::vector<int> result;
    for (int y = bottom; y <= bottom + nodes; ++y)
      for (int x = left; x <= left + nodes; ++x)
        if (const int first = at(x, y); first >= 0) {
          result.push_back(first);
          result.push_back(first + 1);
        }
    std::sort(result.begin(), result.end());
    return result;
  }
};

/// What a process has used so far, the largest of all.
struct Used {
  double time;    ///< of processors [s]
  double memory;  ///< the most [MiB]

  static Used now() {
    rusage usage{};
    getrusage(RUSAGE_SELF, &usage);
    const auto seconds = [](const timeval& t) {
      return static_cast<double>(t.tv_sec) + 1e-6 * static_cast<double>(t.tv_usec);
    };
    double values[] = {seconds(usage.ru_utime) + seconds(usage.ru_stime),
                       static_cast<double>(usage.ru_maxrss) / 1024};
    Ranks::all().largest(values, 2);
    return {values[0], values[1]};
  }
};

void measure(const std::string& way, Square& square) {
  Ranks& all = Ranks::all();
  const SkeletonShape shape{square.size, square.kept, true, square.equationsOf(all.rank())};
  const auto n = static_cast<Eigen::Index>(shape.places.size());
  std::mt19937 random(all.rank());
  std::uniform_real_distribution<double> value(-1, 1);
  Matrix own(n, n);
  for (double& entry : own.reshaped()) entry = value(random);
  own.diagonal().setConstant(2.0 * static_cast<double>(n));
  const Used begin = Used::now();
  const auto skeleton =
      way == "mumps" ? mumpsSkeleton(shape, all) : replicatedSkeleton(shape, multifrontalSolver, all);
  const Used analysed = Used::now();
  constexpr int times = 3;
  for (int i = 0; i < times; ++i)
    if (!skeleton->factorise(own, true, Threads::none())) std::printf("singular\n");
  const Used factorised = Used::now();
  Vector f(shape.size);
  for (int i = 0; i < times; ++i) {
    f.setOnes();
    skeleton->condense(f);
    skeleton->expand(f);
  }
  const Used solved = Used::now();
  std::printf(
      "%s %dx%d %d: %d equations, %d kept; analysis %.3f s, factorisation %.3f s, solution %.4f s; "
      "before %.0f MiB, most %.0f MiB\n",
      way.c_str(), square.width, square.height, square.nodes, shape.size - shape.kept, shape.kept,
      analysed.time - begin.time, (factorised.time - analysed.time) / times,
      (solved.time - factorised.time) / times, begin.memory, solved.memory);
}

/// What the analysis of MUMPS needs and foresees.
void predict(Square& square) {
  Ranks& all = Ranks::all();
  std::vector<MUMPS_INT> rows;
  std::vector<MUMPS_INT> columns;
  for (int part = all.rank(); part < square.width * square.height; part += all.count()) {
    const std::vector<int> places = square.equationsOf(part);
    for (size_t j = 0; j < places.size(); ++j)
      for (size_t i = j; i < places.size(); ++i) {
        rows.push_back(places[i] + 1);
        columns.push_back(places[j] + 1);
      }
  }
  std::vector<MUMPS_INT> kept;
  for (int i = square.size - square.kept; i < square.size; ++i) kept.push_back(i + 1);
  const Used begin = Used::now();
  DMUMPS_STRUC_C id;
  std::memset(&id, 0, sizeof id);
  id.job = -1;
  id.par = 1;
  id.sym = 1;
  id.comm_fortran = -987654;
  dmumps_c(&id);
  for (const int number : {1, 2, 3}) id.icntl[number - 1] = -1;
  for (const int number : {4, 6, 7, 8}) id.icntl[number - 1] = 0;
  id.icntl[17] = 3;
  id.icntl[18] = 1;
  id.n = square.size;
  id.size_schur = square.kept;
  id.listvar_schur = kept.data();
  id.nnz_loc = static_cast<MUMPS_INT8>(rows.size());
  id.irn_loc = rows.data();
  id.jcn_loc = columns.data();
  id.job = 1;
  dmumps_c(&id);
  const Used end = Used::now();
  const double factors = id.infog[19] < 0 ? -1e6 * id.infog[19] : id.infog[19];
  std::printf(
      "%dx%d %d: %d equations, %d kept, %.3g entries of all; analysis %.2f s, %.0f MiB more; of the "
      "factor %.3g entries, %.3g operations, %d MiB at most on one of %d, %d on all\n",
      square.width, square.height, square.nodes, square.size - square.kept, square.kept,
      static_cast<double>(id.keep8[27]), end.time - begin.time, end.memory - begin.memory, factors,
      id.rinfog[0], id.infog[15], all.count(), id.infog[16]);
  id.job = -2;
  dmumps_c(&id);
}

}  // namespace

int main(int argc, char** argv) {
  startRanks(argc, argv);
  if (argc == 5) {
    const std::string way = argv[1];
    Square square(std::atoi(argv[2]), std::atoi(argv[3]), std::atoi(argv[4]));
    if (way == "predict")
      predict(square);
    else
      measure(way, square);
  }
  static_cast<void>(Ranks::all().end(0));
  Ranks::all().leave();
  return 0;
}
