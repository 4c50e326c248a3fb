#include "solver/friction_solutions.h"

#include <algorithm>
#include <cmath>
#include <utility>

#include "solver/friction_path.h"

namespace mortier {
namespace {

/// The sets with which the path begins: everything is open, and t is what the limits c hold.
std::optional<FrictionSets> allOpen(const FrictionSystem& system) {
  constexpr int most = 100;  // solves a condition
  const Matrix& W = system.problem().W;
  const auto& [node, law] = system.problem().rows;
  const Eigen::Index n = system.normals();
  FrictionSets open{std::vector<char>(n, 0), std::vector<signed char>(node.size(), 1)};
  if (law.limit.isZero(0)) return open;
  Vector far = system.q();
  far.head(n) = W.topRightCorner(n, law.limit.size()).cwiseAbs() * law.limit;
  far.head(n) += W.diagonal().head(n) * far.head(n).maxCoeff() / W.diagonal().maxCoeff();
  FrictionSystem apart(system.problem(), far);
  const std::optional<FrictionSolution> held = apart.bounded(law.limit, open, most * (far.size() + 1));
  if (!held) return std::nullopt;
  return held->sets;
}

/// Calls onPath(problem, first sets) for the problem and for two nearby until it returns true.
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
    std::optional<FrictionSets> first = allOpen(moved);
    if (first && onPath(moved, std::move(*first))) return;
  }
}

}  // namespace

std::optional<FrictionSolution> firstOnPath(FrictionSystem& system, int& events) {
  std::optional<FrictionSolution> solution;
  followNearby(system, [&](const FrictionSystem& moved, FrictionSets first) {
    std::optional<FrictionSets> sets = followPath(moved, std::move(first), events);
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
  followNearby(system, [&](const FrictionSystem& moved, FrictionSets first) {
    const std::vector<FrictionSets> passages = followPathBeyond(moved, std::move(first), events);
    for (const FrictionSets& sets : passages)
      if (const std::optional<FrictionSolution> one = system.newton(problem.rows.law, sets);
          one && !isKnown(*one))
        all.push_back(*one);
    return !passages.empty();
  });
  return all;
}

}  // namespace mortier
