#include <algorithm>
#include <cmath>
#include <utility>

#include "base/interrupt.h"
#include "solver/friction_sets.h"

namespace mortier {

std::optional<FrictionSolution> solveBySweeps(const FrictionSystem& system) {
  constexpr int rounds = 40;  // Newton's method after each
  constexpr int sweeps = 25;  // of a round
  const ContactProblem& problem = system.problem();
  const auto& [node, law, components] = problem.along;
  const Springs& springs = system.springs();
  // w = q + W x - G z, z = z0 + (load - G' x)/stiffness
  Matrix W = problem.W;
  FrictionSolution trial;
  trial.motion = system.q();
  if (problem.G.cols() > 0) {
    W += problem.G * problem.G.transpose() / springs.stiffness;
    trial.motion -= problem.G * (springs.z0 + springs.load / springs.stiffness);
  }
  trial.force = Vector::Zero(W.rows());
  trial.sets = system.allHeld();
  trial.sets.slip.assign(trial.sets.slip.size(), 1);
  const auto move = [&](Eigen::Index row, double by) {
    trial.force[row] += by;
    trial.motion += by * W.col(row);
  };
  std::vector<std::vector<Eigen::Index>> nodesOf(system.normals());
  for (size_t k = 0; k < node.size(); ++k) nodesOf[node[k]].push_back(static_cast<Eigen::Index>(k));
  for (int sweep = 1; sweep <= rounds * sweeps; ++sweep) {
    stopIfInterrupted();
    for (Eigen::Index i = 0; i < system.normals(); ++i) {
      if (!system.idle(i)) move(i, std::max(-trial.force[i], -trial.motion[i] / W(i, i)));
      for (const Eigen::Index k : nodesOf[i]) {
        const Eigen::Index row = system.normals() + 2 * k;
        const double compliance = W(row, row) + W(row + 1, row + 1);  // not below the largest eigenvalue
        const double limit = law.coefficient[k] * trial.force[i] + law.limit[k];
        const Point t = trial.force.segment<2>(row);
        const Point change = withinBall(t - trial.motion.segment<2>(row) / compliance, limit) - t;
        move(row, change.x());
        move(row + 1, change.y());
      }
    }
    if (sweep % sweeps != 0) continue;
    if (std::optional<FrictionSolution> found = system.newton(system.next(trial)); found && found->index > 0)
      return found;
  }
  return std::nullopt;
}

}  // namespace mortier
