#include "solver/friction.h"

#include <cmath>
#include <optional>
#include <utility>

#include "solver/friction_sets.h"
#include "solver/friction_solutions.h"

namespace mortier {
namespace {

/// From the solution of Tresca's law under the bounds of the pressure without friction.
std::optional<FrictionSets> fromFixedBounds(FrictionSystem& system) {
  constexpr int most = 50;  // where it takes more, the path is shorter
  const auto& [node, law] = system.problem().rows;
  FrictionSets sets = system.allHeld();
  Vector limit = law.limit;
  for (int repetition = 0; repetition < 2; ++repetition) {
    const std::optional<FrictionSolution> solution = system.bounded(limit, std::move(sets), most);
    if (!solution) return std::nullopt;
    sets = solution->sets;
    for (size_t k = 0; k < node.size(); ++k) {
      const auto row = static_cast<Eigen::Index>(k);
      limit[row] = law.limit[row] + law.coefficient[row] * solution->force[node[k]];
    }
  }
  return sets;
}

/// What solveFriction does where conditions are independent.
FrictionSolution solveIndependent(const FrictionProblem& problem, const Vector& q, const FrictionSets& first,
                                  bool endWhereSingular) {
  FrictionSystem system(problem, q);
  int events = 0;
  // A solution of index -1 is one that no path of loads leads to: Newton's method may meet it.
  const auto good = [](const std::optional<FrictionSolution>& found) { return found && found->index > 0; };
  std::optional<FrictionSolution> found = system.newton(problem.rows.law, first);
  const auto goesOn = [&] { return !good(found) && !(endWhereSingular && system.singular()); };
  if (const FrictionSets held = system.allHeld(); goesOn() && !(first == held))
    found = system.newton(problem.rows.law, held);
  if (goesOn()) {
    std::optional<FrictionSets> nearby = fromFixedBounds(system);
    if (nearby) found = system.newton(problem.rows.law, std::move(*nearby));
  }
  if (goesOn()) found = firstOnPath(system, events);
  FrictionSolution result = good(found) ? std::move(*found) : FrictionSolution();
  result.solves = system.solves();
  result.events = events;
  result.singular = !result.solved && system.singular();
  result.ambiguous = system.ambiguous();
  return result;
}

/// Conditions that depend on each other, as the four at a corner of which both sides touch a rigid body: W
/// is semidefinite. A compliance D of every condition is added, against x0, which follows x until D (x - x0)
/// is nothing (as the springs of friction_motions.h): to it W is W + D.
FrictionSolution solveDependent(const FrictionProblem& problem, const Vector& q, FrictionSets first) {
  constexpr int repetitions = 8;
  constexpr double weight = 1e-8;
  constexpr double nothing = 1e-14;
  const Vector D = weight * problem.W.diagonal().cwiseMax(0);
  Matrix sum = problem.W;
  sum.diagonal() += D;
  Vector x0 = Vector::Zero(q.size());
  FrictionSolution result;
  int solves = 0;
  int events = 0;
  bool ambiguous = false;
  for (int repetition = 0; repetition < repetitions; ++repetition) {
    const Vector at = q - D.cwiseProduct(x0);
    result = solveIndependent({sum, problem.rows, problem.motions}, at, first, false);
    solves += result.solves;
    events += result.events;
    ambiguous = ambiguous || result.ambiguous;
    if (!result.solved) break;
    first = result.sets;
    const Vector left = D.cwiseProduct(result.force - x0);
    x0 = result.force;
    const double size = q.lpNorm<Eigen::Infinity>() + (problem.W * x0).lpNorm<Eigen::Infinity>();
    if (left.lpNorm<Eigen::Infinity>() <= nothing * size) break;
  }
  result.solves = solves;
  result.events = events;
  result.singular = true;
  result.ambiguous = ambiguous;
  return result;
}

}  // namespace

FrictionSolution solveFriction(const FrictionProblem& problem, const Vector& q, const FrictionSets& first) {
  FrictionSolution result = solveIndependent(problem, q, first, true);
  if (result.solved || !result.singular) return result;
  FrictionSolution dependent = solveDependent(problem, q, first);
  dependent.solves += result.solves;
  // A single set may be singular where conditions are independent.
  return dependent.solved ? dependent : solveIndependent(problem, q, first, false);
}

}  // namespace mortier
