// What a guaranteed bound costs: the construction over one factorisation and one solution by CHOLMOD alone on
// the elastic stiffness of the same meshes, on contact with a known end, where the true error is known too;
// nanoseconds a triangle. The peak of memory before it and after it.
//   bench_bound [--cpu] [--rounds N] [--graded] [triangles]...
// --graded: meshes refined for the error of mortar instead of uniform ones.
#include <sys/wait.h>
#include <unistd.h>

#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <cstring>
#include <numeric>
#include <vector>

#include "bare_cholmod.h"
#include "bound/energy_bound.h"
#include "clock.h"
#include "report/clock.h"
#include "theory/adapted.h"

namespace {

using namespace mortier;
using namespace mortier::bench;
using namespace mortier::scenes;

constexpr std::array<Elasticity, 2> elasticity{{{1, 0.3}, {1, 0.3}}};

Model modelOn(const std::vector<TriangleMesh>& meshes, CouplingKind coupling) {
  return contactModel(HalfOpenContact(elasticity[0], false).body(meshes[0]),
                      HalfOpenContact(elasticity[1], true).body(meshes[1]), coupling, upperBody);
}

void row(const std::vector<TriangleMesh>& meshes, CouplingKind coupling, int rounds) {
  const Model model = modelOn(meshes, coupling);
  const State state = run(model, 1, 1).state;
  const double before = peakMemory();
  EnergyBound bound = energyBound(model, state);
  const double after = peakMemory();
  BareCholmod bare;
  double error = 0;
  double norm = 0;
  size_t triangles = 0;
  for (size_t b = 0; b < model.bodies.size(); ++b) {
    bare.add(model.bodies[b]);
    const HalfOpenContact exact(elasticity[b], b == 1);
    addEnergies(
        model.bodies[b], state.bodies[b].stress, [&](const Point& x) { return exact.stress(x.x(), x.y()); },
        elasticity[b], error, norm);
    triangles += model.bodies[b].mesh().triangles.size();
  }
  bare.analyse();
  std::vector<double> unit;
  std::vector<double> cost;
  for (int i = 0; i < rounds; ++i) {
    unit.push_back(secondsOf([&] { bare.factoriseAndSolve(1); }));
    cost.push_back(secondsOf([&] { bound = energyBound(model, state); }));
  }
  std::printf("%9zu %-14s %8.0f %8.0f %6.2f %8.3f %8.0f %8.0f   %s\n", triangles, nameOf(coupling),
              1e9 * median(unit) / static_cast<double>(triangles),
              1e9 * median(cost) / static_cast<double>(triangles), median(cost) / median(unit),
              bound.bound / std::sqrt(error), before, after, bound.obstacle.c_str());
  std::fflush(stdout);
}

std::vector<TriangleMesh> uniform(int triangles) {
  // 2 n^2 triangles above, 9/4 times as many below.
  const int cells = static_cast<int>(std::lround(std::sqrt(triangles / 6.5)));
  return {HalfOpenContact(elasticity[0], false).body(cells).mesh(),
          HalfOpenContact(elasticity[1], true).body(3 * cells / 2 + 1).mesh()};
}

/// Refined where the error of mortar is large, until there are about as many.
std::vector<TriangleMesh> graded(int triangles) {
  const std::vector<TriangleMesh> first = uniform(500);
  AdaptedMeshes meshes(first, 1);
  for (;;) {
    const std::vector<TriangleMesh> now{meshes.mesh(0), meshes.mesh(1)};
    const double ratio = static_cast<double>(now[0].triangles.size() + now[1].triangles.size()) / triangles;
    if (ratio > 0.8) return now;
    const Model model = modelOn(now, CouplingKind::mortar);
    CurrentMeshError current(model);
    ErrorHistory history(model, current);
    State state = initialState(model);
    static_cast<void>(
        march(model, state, {.end = 1, .steps = 1}, {}, [&](const State& at, const StepReport& report) {
          current.moveTo(at);
          history.add(report);
        }));
    double sum = 0;
    for (const Vector& each : history.errors()) sum += each.sum();
    // The error goes like the root of the number of triangles.
    meshes.learn(history.errors());
    meshes.refine(history.errors(), std::sqrt(sum * std::max(ratio, 1. / 16)));
  }
}

}  // namespace

int main(int argc, char** argv) {
  std::vector<int> sizes;
  int rounds = 3;
  bool isGraded = false;
  for (int i = 1; i < argc; ++i) {
    if (std::strcmp(argv[i], "--cpu") == 0)
      timeOf = TimeOf::processor;
    else if (std::strcmp(argv[i], "--graded") == 0)
      isGraded = true;
    else if (std::strcmp(argv[i], "--rounds") == 0 && i + 1 < argc)
      rounds = std::atoi(argv[++i]);
    else
      sizes.push_back(std::atoi(argv[i]));
  }
  if (sizes.empty()) sizes = {10000, 100000, 200000};
  std::printf("%9s %-14s %8s %8s %6s %8s %8s %8s\n", "triangles", "", "unit/ns", "bound/ns", "units", "sharp",
              "MiB", "with");
  std::fflush(stdout);
  for (const int size : sizes)
    for (const CouplingKind coupling : couplings) {
      const pid_t child = fork();  // the peak of memory is that of the row
      if (child == 0) {
        row(isGraded ? graded(size) : uniform(size), coupling, rounds);
        _exit(0);
      }
      int status = 0;
      if (child < 0 || waitpid(child, &status, 0) != child || status != 0) return 1;
    }
  return 0;
}
