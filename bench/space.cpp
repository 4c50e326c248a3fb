// Two boxes in space with quadratic displacements, one pressed on the other: unknowns, rows, and the time of
// each part. And two flat plates that touch: the time of their coupling.
//   build/bench/space [CELLS ...]     cells along an edge of the upper box; the lower one has 13/12 as many
//   build/bench/space --coupling CELLS ...
// And a paraboloid pressed on a block (Hertz), then further by a tenth and by three tenths: active sets.
//   build/bench/space --sets CELLS ...
// And a punch on a block, a quarter of both flowing (Perzyna), in two and in five steps, beside the same of
// elastic bodies: processor time, iterations and factors.
//   build/bench/space --flow CELLS ...
#include <algorithm>
#include <chrono>
#include <cstdio>
#include <cstdlib>
#include <cstring>
#include <ctime>
#include <vector>

#include "material/deviatoric.h"
#include "material/perzyna.h"
#include "mesh/shape.h"
#include "solver/step_system.h"
#include "time/march.h"

using namespace mortier;

namespace {

double now() {
  return std::chrono::duration<double>(std::chrono::steady_clock::now().time_since_epoch()).count();
}

void measure(int cells) {
  const Elasticity elasticity{1000, 0.3};
  const Datum zero = [](const SpacePoint&, double) { return 0.0; };
  const auto held = [&](int label, int component) { return Condition{label, component, zero}; };
  const Datum load = [](const SpacePoint& x, double t) { return -t * (1 + x.x()); };
  const double start = now();
  Model model;
  model.bodies.emplace_back("upper", cuboidMesh({{0.1, 0.1, 0}, {0.9, 0.9, 1}, {cells, cells, cells}}),
                            elasticMaterial(elasticity, Plane::none),
                            Conditions{{held(4, alongX), held(5, alongY)}, {{3, alongZ, load}}}, 2);
  const int finer = cells * 13 / 12;
  model.bodies.emplace_back("lower", cuboidMesh({{0, 0, -1}, {1, 1, 0}, {finer, finer, finer}}),
                            elasticMaterial(elasticity, Plane::none),
                            Conditions{{held(1, alongX), held(1, alongY), held(1, alongZ)}, {}}, 2);
  const double bodies = now();
  addInterface(model, {{0, 1}, {1, 3}, CouplingKind::weighted});
  const double coupled = now();
  State state = initialState(model);
  const RunReport report =
      march(model, state, {.end = 1, .steps = 1}, {}, [](const State&, const StepReport&) {});
  const double solved = now();
  std::printf("%3d %9d + %-9d %6d rows   bodies %7.2f   coupling %6.2f   step %8.2f   linear solves %d%s\n",
              cells, model.bodies[0].freeDofs(), model.bodies[1].freeDofs(), model.interfaces[0].rows(),
              bodies - start, coupled - bodies, solved - coupled, report.iterations,
              report.status == Status::converged ? "" : ("   " + report.reason).c_str());
  std::fflush(stdout);
}

/// Processor time, which other processes lengthen less.
double processorTime() {
  return static_cast<double>(std::clock()) / CLOCKS_PER_SEC;
}

void measureCoupling(int cells) {
  Model model;
  const auto plate = [&](const char* name, double lower, int along) {
    model.bodies.emplace_back(name, cuboidMesh({{0, 0, lower}, {1, 1, lower + 0.1}, {along, along, 1}}),
                              elasticMaterial({1000, 0.3}, Plane::none), Conditions{}, 2);
  };
  plate("upper", 0, cells);
  plate("lower", -0.1, cells * 13 / 12);
  const double start = processorTime();
  addInterface(model, {{0, 1}, {1, 3}, CouplingKind::weighted});
  std::printf("%3d %6d rows   coupling %6.2f\n", cells, model.interfaces[0].rows(), processorTime() - start);
}

void countSets(int cells) {
  const Datum zero = [](const SpacePoint&, double) { return 0.0; };
  const Datum approach = [](const SpacePoint&, double t) { return -0.02 * t; };
  const auto rounded = [&](TetrahedronMesh mesh) {
    for (SpacePoint& x : mesh.vertices) x.z() += (1 - x.z()) * x.head<2>().squaredNorm() / 6;
    return mesh;
  };
  const auto held = [&](int label, int component) { return Condition{label, component, zero}; };
  Model model;
  model.bodies.emplace_back("ball", rounded(cuboidMesh({{0, 0, 0}, {1, 1, 1}, {cells, cells, cells / 2}})),
                            elasticMaterial({1000, 0.3}, Plane::none),
                            Conditions{{held(4, alongX), held(5, alongY), {3, alongZ, approach}}, {}}, 1);
  model.bodies.emplace_back("block", cuboidMesh({{0, 0, -1}, {1, 1, 0}, {cells + 3, cells + 3, cells / 2}}),
                            elasticMaterial({1000, 0.3}, Plane::none),
                            Conditions{{held(4, alongX), held(5, alongY), held(1, alongZ)}, {}}, 1);
  addInterface(model, {{0, 1}, {1, 3}, CouplingKind::weighted});
  StepSystem system(model, {});
  const State state = initialState(model);
  Iterate iterate = startingIterate(state);
  std::printf("%3d %6d rows", cells, model.interfaces[0].rows());
  for (const double time : {1.0, 1.1, 1.43}) {
    const StepData data{time, 0, {}};
    const Step step = system.step(state, data);
    prescribe(model, step, iterate);
    StepOutcome outcome;
    const double start = processorTime();
    const auto factorised = system.linearise(step, iterate, 0, false).factorise(outcome);
    const double made = processorTime();
    if (!factorised) return;
    StepSystem::Condensed condensed = factorised->condense(step, iterate);
    const double begin = processorTime();
    const ContactSolution contact = condensed.solveContact();
    std::printf("   %s%d sets, %d closed (factors %.2f, contact %.2f)", time == 1 ? "cold " : "warm ",
                contact.pivots, static_cast<int>(std::count(contact.active.begin(), contact.active.end(), 1)),
                made - start, processorTime() - begin);
    if (!std::move(condensed).expand(contact, iterate, outcome)) return;
  }
  std::printf("\n");
}

void measureFlow(int cells) {
  const Elasticity elasticity{1000, 0.3};
  double elastic = 0;
  for (const int steps : {0, 2, 5}) {  // 0: elastic, in two
    const auto material = steps == 0 ? elasticMaterial(elasticity, Plane::none)
                                     : perzynaMaterial(elasticity, {10, 1}, Plane::none);
    const auto heldOn = [](int label, double lowered) {
      Conditions conditions;
      for (const int c : {alongX, alongY, alongZ})
        conditions.displacements.push_back({label, c, [lowered, c](const SpacePoint&, double t) {
                                              return c == alongZ ? -lowered * t : 0.0;
                                            }});
      return conditions;
    };
    const double start = processorTime();
    Model model;
    model.bodies.emplace_back("punch", cuboidMesh({{0.2, 0.2, 0}, {0.8, 0.8, 0.6}, {cells, cells, cells}}),
                              material, heldOn(3, 0.01), 2);
    model.bodies.emplace_back("block", cuboidMesh({{0, 0, -1}, {1, 1, 0}, {cells, cells, cells}}), material,
                              heldOn(1, 0), 2);
    addInterface(model, {{0, 1}, {1, 3}, CouplingKind::weighted});
    State state = initialState(model);
    const RunReport report = march(model, state, {.end = 1, .steps = steps == 0 ? 2 : steps}, {},
                                   [](const State&, const StepReport&) {});
    const double time = processorTime() - start;
    if (steps == 0) elastic = time;
    std::printf("%3d %7d + %d unknowns, %s, %d steps: %.2f s (%.1f), %d iterations, %d factors\n", cells,
                model.bodies[0].freeDofs(), model.bodies[1].freeDofs(), steps == 0 ? "elastic" : "flow",
                report.steps, time, time / elastic, report.iterations, report.factorisations);
  }
}

}  // namespace

int main(int argc, char** argv) {
  if (argc > 1 && std::strcmp(argv[1], "--coupling") == 0) {
    std::printf("cells, rows of contact; processor time [s]\n");
    for (int i = 2; i < argc; ++i) measureCoupling(std::atoi(argv[i]));
    return 0;
  }
  if (argc > 1 && std::strcmp(argv[1], "--sets") == 0) {
    std::printf("cells, rows of contact, active sets; processor time [s]\n");
    for (int i = 2; i < argc; ++i) countSets(std::atoi(argv[i]));
    return 0;
  }
  if (argc > 1 && std::strcmp(argv[1], "--flow") == 0) {
    std::printf("cells, unknowns; processor time [s] (over the elastic one)\n");
    for (int i = 2; i < argc; ++i) measureFlow(std::atoi(argv[i]));
    return 0;
  }
  std::printf("cells, unknowns of both bodies, rows of contact; wall time [s]\n");
  if (argc < 2)
    for (const int cells : {6, 9, 12}) measure(cells);
  for (int i = 1; i < argc; ++i) measure(std::atoi(argv[i]));
  return 0;
}
