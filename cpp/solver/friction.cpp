#include "solver/friction.h"

#include <cmath>
#include <optional>
#include <utility>

#include "solver/friction_path.h"
#include "solver/friction_sets.h"

namespace mortier {
namespace {

/// From the solution of Tresca's law under the bounds of the pressure without friction.
std::optional<FrictionSets> fromFixedBounds(FrictionSystem& system) {
  const auto& [node, law] = system.problem().rows;
  FrictionSets sets = system.allHeld();
  Vector limit = law.limit;
  for (int repetition = 0; repetition < 2; ++repetition) {
    const std::optional<FrictionSolution> solution = system.bounded(limit, std::move(sets));
    if (!solution) return std::nullopt;
    sets = solution->sets;
    for (size_t k = 0; k < node.size(); ++k) {
      const auto row = static_cast<Eigen::Index>(k);
      limit[row] = law.limit[row] + law.coefficient[row] * solution->force[node[k]];
    }
  }
  return sets;
}

/// The sets with which the path begins: everything is open, and t is what the limits c hold.
std::optional<FrictionSets> allOpen(const FrictionSystem& system) {
  const Matrix& W = system.problem().W;
  const auto& [node, law] = system.problem().rows;
  const Eigen::Index n = system.normals();
  FrictionSets open{std::vector<char>(n, 0), std::vector<signed char>(node.size(), 1)};
  if (law.limit.isZero(0)) return open;
  Vector far = system.q();
  far.head(n) = W.topRightCorner(n, law.limit.size()).cwiseAbs() * law.limit;
  far.head(n) += W.diagonal().head(n) * far.head(n).maxCoeff() / W.diagonal().maxCoeff();
  FrictionSystem apart(system.problem(), far);
  const std::optional<FrictionSolution> held = apart.bounded(law.limit, open);
  if (!held) return std::nullopt;
  return held->sets;
}

/// Along the path, if need be on a problem nearby: where two things happen at once, as they do in a symmetric
/// one, the path has a corner that it cannot turn.
std::optional<FrictionSolution> alongPath(FrictionSystem& system, int& events) {
  constexpr double turn = 0.754877666246693;
  constexpr double strong = 1e-5;
  // Springs on free motions become a part of W, strong enough to leave its digits there.
  Matrix sprung;
  Vector at = system.q();
  if (const FreeMotions* free = system.problem().motions) {
    const double spring = std::max(free->spring, strong * free->stiffness);
    sprung = system.problem().W + free->G * free->G.transpose() / spring;
    at -= free->G * (free->z0 + free->load / spring);
  }
  const FrictionProblem problem{system.problem().motions != nullptr ? sprung : system.problem().W,
                                system.problem().rows};
  for (const double nearby : {0.0, 1e-9, 1e-7}) {
    Vector q = at;
    const double largest = q.lpNorm<Eigen::Infinity>();
    for (Eigen::Index i = 0; i < q.size(); ++i) {
      const double place = turn * static_cast<double>(i + 1);
      q[i] += nearby * largest * (place - std::floor(place) - 0.5);
    }
    const FrictionSystem moved(problem, q);
    std::optional<FrictionSets> sets = allOpen(moved);
    if (sets) sets = followPath(moved, std::move(*sets), events);
    if (!sets) continue;
    std::optional<FrictionSolution> solution = system.newton(problem.rows.law, std::move(*sets));
    if (solution && solution->index > 0) return solution;
  }
  return std::nullopt;
}

}  // namespace

FrictionSolution solveFriction(const FrictionProblem& problem, const Vector& q, const FrictionSets& first) {
  FrictionSystem system(problem, q);
  int events = 0;
  // A solution of index -1 is one that no path of loads leads to: Newton's method may meet it.
  const auto good = [](const std::optional<FrictionSolution>& found) { return found && found->index > 0; };
  std::optional<FrictionSolution> found = system.newton(problem.rows.law, first);
  if (!good(found)) found = system.newton(problem.rows.law, system.allHeld());
  if (!good(found)) {
    std::optional<FrictionSets> nearby = fromFixedBounds(system);
    if (nearby) found = system.newton(problem.rows.law, std::move(*nearby));
  }
  if (!good(found)) found = alongPath(system, events);
  FrictionSolution result = good(found) ? std::move(*found) : FrictionSolution();
  result.solves = system.solves();
  result.events = events;
  result.singular = !result.solved && system.singular();
  return result;
}

}  // namespace mortier
