// Contact of long thin strips without dense matrices over the contact conditions, and with them.
//   long_lines NODES          a strip of two layers in waves of contact, about 4 triangles a node:
//                              time and peak memory of the process (with dense matrices: `dense` after it)
//   long_lines random COUNT   random lines (tests/theory/random_line.h) both ways, and how far apart
//   long_lines threshold      both ways for growing strips and squares
#include <sys/resource.h>

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
  options.denseEntries = dense ? 1e300 : 0;
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

void randomLines(int count) {
  double force = 0;
  double displacement = 0;
  int apart = 0;
  int otherEnd = 0;
  for (int seed = 0; seed < count; ++seed) {
    const RandomLine line = randomLine(static_cast<unsigned>(seed), 40);
    const Difference difference = denseAndSparse(line);
    otherEnd += difference.sameEnd ? 0 : 1;
    const double most = std::max(difference.force, difference.displacement);
    apart += most > 1e-10 ? 1 : 0;
    if (most > 1e-10 || !difference.sameEnd)
      std::printf("  seed %d: %s: force %.1e, displacement %.1e%s\n", seed, line.words.c_str(),
                  difference.force, difference.displacement, difference.sameEnd ? "" : ", another end");
    force = std::max(force, difference.force);
    displacement = std::max(displacement, difference.displacement);
  }
  std::printf(
      "%d random lines: forces agree to %.1e, displacements to %.1e; %d beyond 1e-10, %d end otherwise\n",
      count, force, displacement, apart, otherEnd);
}

void threshold() {
  std::printf("%10s %8s %10s %12s %10s %10s\n", "conditions", "layers", "equations", "n^2/equation", "dense",
              "sparse");
  for (const auto& [nodes, layers] : std::initializer_list<std::pair<int, int>>{{50, 1},
                                                                                {100, 1},
                                                                                {200, 1},
                                                                                {400, 1},
                                                                                {800, 1},
                                                                                {100, 4},
                                                                                {200, 4},
                                                                                {400, 4},
                                                                                {800, 4},
                                                                                {100, 32},
                                                                                {200, 32},
                                                                                {400, 32},
                                                                                {100, 100},
                                                                                {200, 200}}) {
    const Model model = strip(nodes, layers, elasticMaterial({100, 0.3}));
    SolverOptions options;
    const double n = model.interfaces[0].rows();
    const double equations = model.bodies[0].freeDofs() + model.bodies[1].freeDofs();
    double seconds[2];
    for (const bool dense : {true, false}) {
      options.denseEntries = dense ? 1e300 : 0;
      std::vector<double> times;
      for (int i = 0; i < 3; ++i) times.push_back(bench::secondsOf([&] { run(model, 1, 1, options); }));
      seconds[dense ? 0 : 1] = bench::median(times);
    }
    std::printf("%10.0f %8d %10.0f %12.1f %9.3fs %9.3fs\n", n, layers, equations, n * n / equations,
                seconds[0], seconds[1]);
    std::fflush(stdout);
  }
}

}  // namespace

int main(int argc, char** argv) {
  const std::string what = argc > 1 ? argv[1] : "100000";
  if (what == "threshold")
    threshold();
  else if (what == "random")
    randomLines(argc > 2 ? std::atoi(argv[2]) : 1000);
  else
    one(std::atoi(what.c_str()), argc > 2 && std::strcmp(argv[2], "dense") == 0);
  return 0;
}
