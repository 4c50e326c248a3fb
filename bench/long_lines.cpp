// Contact of long thin strips without dense matrices over the contact conditions, and with them.
//   long_lines NODES          a strip of two layers in waves of contact, about 4 triangles a node:
//                              time and peak memory of the process (with dense matrices: `dense` after it)
//   long_lines random COUNT FIRST   random lines (tests/theory/random_line.h) both ways, and how far apart
//   long_lines threshold      processor time and peak memory of both ways for strips of growing thickness
#include <sys/resource.h>
#include <sys/wait.h>
#include <unistd.h>

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <cstring>
#include <string>

#include "clock.h"
#include "theory/random_line.h"

namespace {

using namespace mortier;
using namespace mortier::scenes;

/// Two layers, the lower one on rollers, under waves of load that press and lift: most of the line opens.
Model strip(int nodes, int layers, const std::shared_ptr<const Material>& material) {
  const double length = nodes - 1;
  const Function load = [](double x, double, double t) {
    return -0.1 * t * (1 + 2 * std::cos(2 * std::numbers::pi * x / 100)) * (1 + 0.5 * std::cos(x / 7777));
  };
  const auto mesh = [&](double y, int cells) {
    return rectangleMesh({{0, y}, {length, y + layers}, cells, layers});
  };
  Body upper("upper", mesh(0, nodes - 1), material, {{{left, 0, constant(0)}}, {{top, 1, load}}, {}});
  Body lower("lower", mesh(-layers, nodes - 2), material,
             {{{left, 0, constant(0)}, {bottom, 1, constant(0)}}, {}, {}});
  return contactModel(std::move(upper), std::move(lower), CouplingKind::mortar, upperBody);
}

double peakMebibytes() {
  rusage usage{};
  getrusage(RUSAGE_SELF, &usage);
  return static_cast<double>(usage.ru_maxrss) / 1024;
}

void one(int nodes, bool dense) {
  const double begin = bench::now();
  const Model model = strip(nodes, 1, elasticMaterial({100, 0.3}));
  size_t triangles = 0;
  for (const Body& body : model.bodies) triangles += body.mesh().triangles.size();
  const double made = bench::now();
  SolverOptions options;
  options.denseWork = dense ? 1e300 : 0;
  const Result result = run(model, 1, 1, options);
  int active = 0;
  for (const double p : result.state.contactForce[0]) active += p > 0 ? 1 : 0;
  const Certificate& worst = result.report.worst;
  std::printf("%d conditions, %zu triangles, %s: %.2f s (model %.2f s), peak %.0f MiB, %d closed\n",
              model.interfaces[0].rows(), triangles, dense ? "dense" : "sparse", bench::now() - begin,
              made - begin, peakMebibytes(), active);
  std::printf("  %s%s; force balance %.1e, gap %.1e, penetration %.1e, sign %.1e, complementarity %.1e\n",
              result.report.status == Status::converged ? "converged" : "not converged: ",
              result.report.reason.c_str(), worst.forceBalance, worst.gapOnActive, worst.openPenetration,
              worst.sign, worst.complementarity);
}

void randomLines(int first, int count, int most) {
  double force = 0;
  double displacement = 0;
  int apart = 0;
  int otherEnd = 0;
  int unsolved = 0;
  int usual = 0;  // dense with the usual tolerance
  for (int seed = first; seed < first + count; ++seed) {
    const RandomLine line = randomLine(static_cast<unsigned>(seed), most);
    const Difference difference = denseAndSparse(line);
    otherEnd += difference.sameEnd ? 0 : 1;
    const Difference loose =
        differenceOf(runLine(line, denseContact(1e-10)), runLine(line, denseContact(1e-13)));
    usual += std::max(loose.force, loose.displacement) > 1e-10 ? 1 : 0;
    unsolved += difference.sameEnd && !difference.converged ? 1 : 0;
    const double larger = std::max(difference.force, difference.displacement);
    apart += larger > 1e-10 ? 1 : 0;
    if (larger > 1e-10 || !difference.sameEnd)
      std::printf("  seed %d: %s: force %.1e, displacement %.1e%s\n", seed, line.words.c_str(),
                  difference.force, difference.displacement, difference.sameEnd ? "" : ", another end");
    force = std::max(force, difference.force);
    displacement = std::max(displacement, difference.displacement);
  }
  std::printf(
      "%d random lines: forces agree to %.1e, displacements to %.1e; %d beyond 1e-10, %d end otherwise, %d "
      "are solved by neither; dense with the usual tolerance: %d beyond 1e-10\n",
      count, force, displacement, apart, otherEnd, unsolved, usual);
}

struct Cost {
  double seconds = INFINITY;  ///< of processor time
  double mebibytes = 0;
};

/// Of a process of its own, the least time of several.
template <class Work>
Cost costOf(int times, Work work) {
  Cost cost;
  for (int i = 0; i < times; ++i) {
    const pid_t child = fork();
    if (child == 0) {
      work();
      _exit(0);
    }
    int status = 0;
    rusage usage{};
    wait4(child, &status, 0, &usage);
    const auto seconds = [](const timeval& t) {
      return static_cast<double>(t.tv_sec) + 1e-6 * static_cast<double>(t.tv_usec);
    };
    cost.seconds = std::min(cost.seconds, seconds(usage.ru_utime));
    cost.mebibytes = static_cast<double>(usage.ru_maxrss) / 1024;
  }
  return cost;
}

void threshold() {
  std::printf("%10s %8s %10s %12s %22s %22s\n", "conditions", "layers", "equations", "n^2/equation",
              "dense [s, MiB]", "sparse [s, MiB]");
  for (const int layers : {1, 4, 16, 64, 200})
    for (const int nodes : {50, 100, 200, 400, 800, 1600}) {
      if (nodes * layers > 50000 || layers > nodes) continue;
      const auto material = elasticMaterial({100, 0.3});
      const Model model = strip(nodes, layers, material);
      const double n = model.interfaces[0].rows();
      const double equations = model.bodies[0].freeDofs() + model.bodies[1].freeDofs();
      const auto runIt = [&](double denseWork) {
        return costOf(nodes * layers > 10000 ? 3 : 5, [&] {
          SolverOptions options;
          options.denseWork = denseWork;
          run(model, 1, 1, options);
        });
      };
      const Cost dense = runIt(INFINITY);
      const Cost sparse = runIt(0);
      std::printf("%10.0f %8d %10.0f %12.1f %12.3f %9.0f %12.3f %9.0f\n", n, layers, equations,
                  n * n / equations, dense.seconds, dense.mebibytes, sparse.seconds, sparse.mebibytes);
      std::fflush(stdout);
    }
}

}  // namespace

int main(int argc, char** argv) {
  const std::string what = argc > 1 ? argv[1] : "100000";
  if (what == "threshold")
    threshold();
  else if (what == "random")
    randomLines(argc > 3 ? std::atoi(argv[3]) : 0, argc > 2 ? std::atoi(argv[2]) : 1000, 40);
  else
    one(std::atoi(what.c_str()), argc > 2 && std::strcmp(argv[2], "dense") == 0);
  return 0;
}
