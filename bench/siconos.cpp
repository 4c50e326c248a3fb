// Contact problems with friction, of ours, in Siconos (Debian: libsiconos-numerics-dev): the same (W, q, mu),
// and the difference of the forces, over the largest. Siconos solves them by Lemke's method
// (fc2d_lexicolemke) and by projected Gauss-Seidel (fc2d_nsgs).
//   siconos [RANDOM PROBLEMS]   (default 1000)
#include <FrictionContactProblem.h>
#include <Friction_cst.h>
#include <NonSmoothDrivers.h>
#include <NumericsMatrix.h>
#include <SolverOptions.h>

#include <cstdio>
#include <cstdlib>

#include "mesh/generate.h"
#include "solver/complementarity.h"
#include "solver/solve_step.h"
#include "solver/step_system.h"
#include "theory/scenes.h"
#include "unit/half_plane_friction.h"

namespace mortier {
namespace {

constexpr double sameForces = 1e-9;

/// How far forces (p, t) are from the law, over the largest force and motion.
double fault(const FrictionCase& c, const Vector& force) {
  const Eigen::Index n = c.problem.normals();
  const Vector w = c.q + c.problem.W * force;
  const double most = std::max(force.lpNorm<Eigen::Infinity>(), 1e-300);
  const double motion = c.q.lpNorm<Eigen::Infinity>();
  double worst = 0;
  for (Eigen::Index i = 0; i < n; ++i) {
    const double p = force[i] / most;
    const double t = force[n + i] / most;
    const double g = w[i] / motion;
    const double v = w[n + i] / motion;
    const double bound = c.problem.along.law.coefficient[i] * p;
    worst = std::max({worst, -p, -g, std::abs(std::min(p, g)), std::abs(t) - bound,
                      std::abs(t * v + bound * std::abs(v))});
  }
  return worst;
}

/// Forces (p, t) by a solver of Siconos; empty where it finds none.
Vector bySiconos(const FrictionCase& c, int solver) {
  const Eigen::Index n = c.problem.normals();
  const auto ours = [&](Eigen::Index i) { return i / 2 + (i % 2) * n; };
  NumericsMatrix* matrix = NM_create(NM_DENSE, static_cast<int>(2 * n), static_cast<int>(2 * n));
  Vector q(2 * n);
  for (Eigen::Index j = 0; j < 2 * n; ++j) {
    q[j] = c.q[ours(j)];
    for (Eigen::Index i = 0; i < 2 * n; ++i) matrix->matrix0[i + 2 * n * j] = c.problem.W(ours(i), ours(j));
  }
  Vector mu = c.problem.along.law.coefficient;
  FrictionContactProblem problem{2, static_cast<int>(n), matrix, q.data(), mu.data()};
  ::SolverOptions* options = solver_options_create(solver);
  options->dparam[SICONOS_DPARAM_TOL] = 1e-13;
  options->iparam[SICONOS_IPARAM_MAX_ITER] = 100000;
  Vector reaction = Vector::Zero(2 * n);
  Vector velocity = Vector::Zero(2 * n);
  const int failed = fc2d_driver(&problem, reaction.data(), velocity.data(), options);
  solver_options_delete(options);
  NM_free(matrix);
  Vector force(2 * n);
  for (Eigen::Index i = 0; i < 2 * n; ++i) force[ours(i)] = reaction[i];
  return failed == 0 && force.allFinite() && fault(c, force) < 1e-8 ? force : Vector();
}

struct Tally {
  const char* name;
  int problems = 0;
  int several = 0;       ///< Siconos finds another solution
  int unsolved[2] = {};  ///< by Siconos
  double worst[2] = {};  ///< difference where both find one
  double ourFault = 0;

  void add(const FrictionCase& c, const Vector& force) {
    ++problems;
    ourFault = std::max(ourFault, fault(c, force));
    bool other = false;
    for (const int k : {0, 1}) {
      const Vector theirs = bySiconos(c, k == 0 ? SICONOS_FRICTION_2D_LEMKE : SICONOS_FRICTION_2D_NSGS);
      if (theirs.size() == 0) {
        ++unsolved[k];
        continue;
      }
      const double difference = (theirs - force).lpNorm<Eigen::Infinity>() / force.lpNorm<Eigen::Infinity>();
      // Far from ours and on the law as well.
      if (difference > 1e-4 && fault(c, theirs) < 1e-10)
        other = true;
      else
        worst[k] = std::max(worst[k], difference);
    }
    several += other ? 1 : 0;
  }
  void print() const {
    std::printf("%-44s %6d %8d %10d %10d %11.1e %11.1e %11.1e\n", name, problems, several, unsolved[0],
                unsolved[1], worst[0], worst[1], ourFault);
  }
};

/// What the solver itself finds.
Vector solved(const FrictionCase& c) {
  const auto n = static_cast<size_t>(c.problem.normals());
  return solveFriction(c.problem, c.q, {std::vector<char>(n, 0), std::vector<signed char>(n, 1)}).force;
}

/// The contact problem of an elastic step.
FrictionCase problemOf(const Model& model, const State& before, double time) {
  StepSystem system(model, {});
  const StepData data{time, time - before.time, {}};
  const Step step = system.step(before, data);
  Iterate iterate = startingIterate(before);
  prescribe(model, step, iterate);
  StepOutcome outcome;
  const auto factorised = system.linearise(step, iterate, 0, false).factorise(outcome);
  const StepSystem::Condensed condensed = factorised->condense(step, iterate);
  const Matrix& W = factorised->contact().W;
  return frictionCase(W, model.interfaces[0].friction().coefficient, condensed.slack - W * condensed.p0);
}

/// A block pressed on another one and moved to and fro along it, on meshes that do not match.
Tally marched(const char* name, double ratio, double mu) {
  using namespace scenes;
  Tally tally{name};
  Model model;
  const Function down = [](double, double, double t) { return -0.01 * std::min(t, 1.0); };
  const Function along = [](double, double, double t) { return t < 1 ? 0 : 0.012 * std::sin(2 * (t - 1)); };
  model.bodies.emplace_back("upper", rectangleMesh({{0, 0}, {1, 0.5}, 24, 12}, Cut::both),
                            elasticMaterial({1, 0.3}), Conditions{{{top, 1, down}, {top, 0, along}}, {}, {}});
  model.bodies.emplace_back("lower", rectangleMesh({{-1, -1}, {2, 0}, 50, 16}, Cut::both),
                            elasticMaterial({ratio, 0.3}),
                            Conditions{{{bottom, 0, constant(0)}, {bottom, 1, constant(0)}}, {}, {}});
  InterfaceOptions options;
  options.friction = {mu, 0};
  addInterface(model, {{0, bottom}, {1, top}, CouplingKind::mortar}, options);
  State before = initialState(model);
  State state = before;
  march(model, state, {.end = 5, .steps = 50}, {}, [&](const State& now, const StepReport& report) {
    if (report.step == 0) return;
    Vector force(2 * now.contactForce[0].size());
    force << now.contactForce[0], now.frictionForce[0];
    tally.add(problemOf(model, before, now.time), force);
    before = now;
  });
  return tally;
}

}  // namespace
}  // namespace mortier

int main(int argc, char** argv) {
  using namespace mortier;
  const int count = argc > 1 ? std::atoi(argv[1]) : 1000;
  std::printf("%-44s %6s %8s %10s %10s %11s %11s %11s\n", "", "", "other", "unsolved:", "", "difference:", "",
              "ours off");
  std::printf("%-44s %6s %8s %10s %10s %11s %11s %11s\n", "problems of", "number", "solution", "Lemke",
              "nsgs", "Lemke", "nsgs", "the law");
  std::vector<Tally> tallies;
  tallies.push_back(marched("blocks, mu 0.3, 50 steps of a run", 1, 0.3));
  tallies.back().print();
  tallies.push_back(marched("the same on a plank 1000 times as stiff", 1000, 0.3));
  tallies.back().print();
  Tally history{"a half plane, 60 nodes, a history"};
  double slip = 0;
  for (int step = 1; step <= 40; ++step) {
    const FrictionCase c = stepOfHistory(60, step, 10, slip);
    history.add(c, solved(c));
  }
  tallies.push_back(history);
  history.print();
  Tally mindlin{"Cattaneo and Mindlin, 60 and 240 nodes"};
  for (const int n : {60, 240}) {
    const FrictionCase c = mindlinCase(n, 0.4);
    mindlin.add(c, solved(c));
  }
  tallies.push_back(mindlin);
  mindlin.print();
  Tally small{"random blocks, 2 to 5 nodes, mu up to 2"};
  Randoms random(11);
  for (int trial = 0; trial < count; ++trial) {
    const FrictionCase c = randomBlocks(random, 2 + trial % 4, 2.0 * random.below(1001) / 1000);
    small.add(c, solved(c));
  }
  tallies.push_back(small);
  small.print();
  double worst = 0;
  for (const Tally& tally : tallies) worst = std::max({worst, tally.worst[0], tally.worst[1]});
  std::printf("largest difference %.1e\n", worst);
  return worst <= sameForces ? 0 : 1;
}
