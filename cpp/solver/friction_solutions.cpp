#include "solver/friction_solutions.h"

#include <algorithm>
#include <cmath>
#include <utility>

#include "solver/friction_path.h"

namespace mortier {
namespace {

/// Calls onPath(problem) for the problem and for two nearby until it returns true.
template <class OnPath>
void followNearby(const FrictionSystem& system, OnPath onPath) {
  constexpr double turn = 0.754877666246693;
  for (const double nearby : {0.0, 1e-9, 1e-7}) {
    Vector q = system.q();
    const double largest = q.lpNorm<Eigen::Infinity>();
    for (Eigen::Index i = 0; i < q.size(); ++i) {
      const double place = turn * static_cast<double>(i + 1);
      q[i] += nearby * largest * (place - std::floor(place) - 0.5);
    }
    const FrictionSystem moved(system.problem(), q);
    if (onPath(moved)) return;
  }
}

}  // namespace

std::optional<FrictionSolution> firstOnPath(FrictionSystem& system, int& events) {
  std::optional<FrictionSolution> solution;
  followNearby(system, [&](const FrictionSystem& moved) {
    std::optional<FrictionSets> sets = followPath(moved, events);
    if (sets) solution = system.newton(system.problem().rows.law, std::move(*sets));
    if (solution && solution->index < 0) solution.reset();
    return solution.has_value();
  });
  return solution;
}

std::vector<FrictionSolution> solutionsOnPath(const FrictionProblem& problem, const Vector& q,
                                              const FrictionSolution& taken) {
  constexpr double same = 1e-9;
  std::vector<FrictionSolution> all{taken};
  const auto isKnown = [&](const FrictionSolution& one) {
    return std::any_of(all.begin(), all.end(), [&](const FrictionSolution& other) {
      const double size =
          std::max(one.force.lpNorm<Eigen::Infinity>(), other.force.lpNorm<Eigen::Infinity>());
      return one.sets == other.sets || (one.force - other.force).lpNorm<Eigen::Infinity>() <= same * size;
    });
  };
  FrictionSystem system(problem, q);
  int events = 0;
  followNearby(system, [&](const FrictionSystem& moved) {
    const std::vector<FrictionSets> passages = followPathBeyond(moved, events);
    for (const FrictionSets& sets : passages)
      if (const std::optional<FrictionSolution> one = system.newton(problem.rows.law, sets);
          one && !isKnown(*one))
        all.push_back(*one);
    return !passages.empty();
  });
  return all;
}

}  // namespace mortier
