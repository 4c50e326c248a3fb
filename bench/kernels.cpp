// The parts of a viscoplastic Newton iteration, one by one, on the meshes of squares.h.
#include <benchmark/benchmark.h>

#include <map>
#include <numeric>

#include "linear/condensing_solver.h"
#include "solver/solve_step.h"
#include "squares.h"
#include "time/march.h"
#include "unit/straight_lines.h"

namespace mortier::bench {
namespace {

Projection projectionOf(const benchmark::State& run) {
  return run.range(1) == 0 ? Projection::frobenius : Projection::elasticity;
}

Cells cellsOf(const benchmark::State& run) {
  return cellsFor(static_cast<double>(run.range(0)));
}

/// The lower body in flow, its law linearised, its tangent assembled, the contact dofs kept.
struct Fixture {
  explicit Fixture(const benchmark::State& run)
      : model(twoSquares(cellsOf(run), projectionOf(run), CouplingKind::mortar)),
        body(model.bodies[1]),
        state(flowing(model)) {
    strain = Matrix::Zero(3, body.points());
    law.predictor.resize(3, body.points());
    law.moduli.resize(9, body.points());
    linearise();
    body.tangent(law.moduli, values);
    for (const int node : model.interfaces[0].mortarNodes()) {
      const int equation = body.equations()[2 * node + 1];
      if (equation >= 0) kept.push_back(equation);
    }
  }

  void linearise() {
    const Matrix& stress = state.bodies[1].stress;
    benchmark::DoNotOptimize(
        body.material().linearise({timeStep, stress, strain}, stress, law, 0, body.points()));
  }

  Model model;
  const Body& body;
  State state;
  Matrix strain;
  Linearisation law;
  std::vector<double> values;
  std::vector<int> kept;
};

void perTriangle(benchmark::State& run, const Body& body) {
  run.SetItemsProcessed(run.iterations() * body.points());
}

void coupling(benchmark::State& run) {
  const Cells cells = cellsOf(run);
  Trace nonmortar(cells.upper + 1);
  Trace mortar(cells.lower + 1);
  for (int i = 0; i <= cells.upper; ++i) nonmortar[i] = static_cast<double>(i) / cells.upper;
  for (int i = 0; i <= cells.lower; ++i) mortar[i] = static_cast<double>(i) / cells.lower;
  const CouplingKind kind = run.range(1) == 0 ? CouplingKind::mortar : CouplingKind::interpolation;
  const StraightLines lines(nonmortar, mortar);
  for ([[maybe_unused]] const auto turn : run) benchmark::DoNotOptimize(couple(kind, lines.refinement));
}

void strain(benchmark::State& run) {
  Fixture at(run);
  const TwoPartVector u{Vector::LinSpaced(at.body.dofs(), 0, 1), Vector::Zero(at.body.dofs())};
  for ([[maybe_unused]] const auto turn : run) {
    at.body.strain(u, nullptr, at.strain, 0, at.body.points());
    benchmark::ClobberMemory();
  }
  perTriangle(run, at.body);
}

void linearise(benchmark::State& run) {
  Fixture at(run);
  for ([[maybe_unused]] const auto turn : run) at.linearise();
  perTriangle(run, at.body);
}

void tangent(benchmark::State& run) {
  Fixture at(run);
  for ([[maybe_unused]] const auto turn : run) {
    at.body.tangent(at.law.moduli, at.values);
    benchmark::ClobberMemory();
  }
  perTriangle(run, at.body);
}

void internalForce(benchmark::State& run) {
  Fixture at(run);
  for ([[maybe_unused]] const auto turn : run)
    benchmark::DoNotOptimize(at.body.internalForce(at.law.predictor));
  perTriangle(run, at.body);
}

void factorise(benchmark::State& run) {
  Fixture at(run);
  const auto solver = multifrontalSolver(at.body.pattern(), at.kept);
  for ([[maybe_unused]] const auto turn : run)
    if (!solver->factorise(at.values)) run.SkipWithError("singular");
  perTriangle(run, at.body);
}

void condenseAndExpand(benchmark::State& run) {
  Fixture at(run);
  const auto solver = multifrontalSolver(at.body.pattern(), at.kept);
  if (!solver->factorise(at.values)) run.SkipWithError("singular");
  Vector f = Vector::Ones(at.body.freeDofs());
  for ([[maybe_unused]] const auto turn : run) {
    f.setOnes();
    solver->condense(f);
    solver->expand(f);
    benchmark::ClobberMemory();
  }
  perTriangle(run, at.body);
}

/// Both bodies, contact and all: one Newton iteration of one step from the state of uniform flow.
void wholeIteration(benchmark::State& run) {
  const Model model = twoSquares(cellsOf(run), projectionOf(run), CouplingKind::mortar);
  const State state = flowing(model);
  SolverOptions options;
  options.threads = static_cast<int>(run.range(2));
  StepSystem system(model, options);
  const StepData step{flowingTime + timeStep, timeStep, {}};
  Iterate solution = startingIterate(state);
  if (!solveStep(system, state, step, solution).converged()) run.SkipWithError("not converged");
  int iterations = 0;
  for ([[maybe_unused]] const auto turn : run) {
    Iterate guess = solution;
    iterations += solveStep(system, state, step, guess).iterations;
  }
  run.counters["iterations"] = benchmark::Counter(iterations, benchmark::Counter::kAvgIterations);
  run.SetItemsProcessed(run.iterations() * cellsOf(run).triangles());
}

const std::vector<int64_t> sizes{1200, 10000, 100000};

BENCHMARK(coupling)->ArgNames({"triangles", "interpolation"})->ArgsProduct({sizes, {0, 1}});
BENCHMARK(strain)->ArgNames({"triangles", "lu"})->ArgsProduct({sizes, {0}});
BENCHMARK(linearise)->ArgNames({"triangles", "lu"})->ArgsProduct({sizes, {0, 1}});
BENCHMARK(tangent)->ArgNames({"triangles", "lu"})->ArgsProduct({sizes, {0, 1}});
BENCHMARK(internalForce)->ArgNames({"triangles", "lu"})->ArgsProduct({sizes, {0}});
BENCHMARK(factorise)->ArgNames({"triangles", "lu"})->ArgsProduct({sizes, {0, 1}});
BENCHMARK(condenseAndExpand)->ArgNames({"triangles", "lu"})->ArgsProduct({sizes, {0, 1}});
BENCHMARK(wholeIteration)
    ->ArgNames({"triangles", "lu", "threads"})
    ->ArgsProduct({sizes, {0, 1}, {1, 2}})
    ->UseRealTime();

}  // namespace
}  // namespace mortier::bench

BENCHMARK_MAIN();
