// What friction costs and how exact it is:
//   dense solves a step of a history (tests/unit/half_plane_friction.h), by nodes and steps;
//   a linear solve of two squares in contact, processor time over that without friction;
//   the traction of Cattaneo and Mindlin, L1, over Q.
// friction_cost [TRIANGLES]   (default 1e5)
#include <cstdio>
#include <cstdlib>
#include <vector>

#include "clock.h"
#include "squares.h"
#include "time/march.h"
#include "unit/half_plane_friction.h"

namespace mortier::bench {
namespace {

void printSolves(int n, int steps) {
  FrictionSets sets{std::vector<char>(n, 0), std::vector<signed char>(n, 1)};
  double slip = 0;
  int solves = 0;
  int most = 0;
  int paths = 0;
  int unsolved = 0;
  for (int step = 1; step <= 4 * steps; ++step) {
    const FrictionCase c = stepOfHistory(n, step, steps, slip);
    const FrictionSolution solution = solveFriction(c.problem, c.q, sets);
    unsolved += solution.solved ? 0 : 1;
    paths += solution.events > 0 ? 1 : 0;
    solves += solution.solves;
    most = std::max(most, solution.solves);
    if (solution.solved) sets = solution.sets;
  }
  std::printf("%3d nodes, %3d steps: %.2f dense solves a step, %2d at most, path taken in %d, unsolved %d\n",
              n, 4 * steps, static_cast<double>(solves) / (4 * steps), most, paths, unsolved);
}

/// Seconds of the processor of one linear solve, everything included.
double secondsOfASolve(double triangles, double mu) {
  const auto material = perzynaMaterial(elasticity, {viscosity, yieldStress, Projection::frobenius});
  const Cells cells = cellsFor(triangles);
  Model model;
  model.bodies.push_back(squareBody(true, cells, material, false));
  model.bodies.push_back(squareBody(false, cells, material, false));
  InterfaceOptions options;
  options.friction = {mu, 0};
  addInterface(model, {{0, 1}, {1, 3}, CouplingKind::mortar}, options);
  State state = flowing(model);
  const int along = mu > 0 ? model.interfaces[0].rows() : 0;
  state.frictionForce.push_back(Vector::Zero(along));
  state.slipping.emplace_back(along, static_cast<signed char>(0));
  std::vector<double> seconds;
  double begin = now();
  march(model, state, {.end = flowingTime + 12 * timeStep, .steps = 12}, {},
        [&](const State&, const StepReport& step) {
          if (step.step > 2 && step.iterations > 0) seconds.push_back((now() - begin) / step.iterations);
          begin = now();
        });
  return median(seconds);
}

}  // namespace
}  // namespace mortier::bench

int main(int argc, char** argv) {
  using namespace mortier;
  using namespace mortier::bench;
  const double triangles = argc > 1 ? std::atof(argv[1]) : 1e5;
  timeOf = TimeOf::processor;
  for (const int n : {60, 200})
    for (const int steps : {10, 100}) printSolves(n, steps);
  for (const int n : {60, 120, 240}) {
    constexpr double mu = 0.4;
    const FrictionCase c = mindlinCase(n, mu);
    const FrictionSolution solution =
        solveFriction(c.problem, c.q, {std::vector<char>(n, 0), std::vector<signed char>(n, 1)});
    const Vector t = solution.force.tail(n);
    const Vector exact = mindlinTraction(n, mu, solution.force.head(n).sum(), t.sum());
    std::printf("%3d nodes: traction of Cattaneo and Mindlin off by %.2g of Q\n", n,
                (t - exact).lpNorm<1>() / t.sum());
  }
  const double smooth = secondsOfASolve(triangles, 0);
  const double rough = secondsOfASolve(triangles, 0.3);
  std::printf("%d triangles: a linear solve %.0f ms, with friction %.0f ms, %.2f times\n",
              cellsFor(triangles).triangles(), 1e3 * smooth, 1e3 * rough, rough / smooth);
}
