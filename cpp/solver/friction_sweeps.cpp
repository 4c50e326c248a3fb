#include <algorithm>
#include <cmath>
#include <utility>

#include "base/interrupt.h"
#include "solver/friction_sets.h"

namespace mortier {

std::optional<FrictionSolution> solveBySweeps(const FrictionSystem& system) {
  constexpr int first = 25;       // sweeps before Newton's method is tried, then twice as many
  constexpr double most = 25600;  // of few conditions; slow where compliances are far apart
  constexpr double least = 1600;
  constexpr double work = 1e9;   // products
  constexpr double stiff = 0.1;  // springs, over the stiffness of contact
  const ContactProblem& problem = system.problem();
  const auto& [node, law, components] = problem.along;
  const Matrix& G = problem.G;
  // w = q + W x - G z, z = z0 + (load - G' x)/stiffness, z0 taken anew after each sweep
  Matrix W = problem.W;
  Vector z = system.springs().z0;
  const double stiffness = stiff * G.squaredNorm() / W.diagonal().maxCoeff();
  if (G.cols() > 0) W += G * G.transpose() / stiffness;
  FrictionSolution trial;
  trial.force = Vector::Zero(W.rows());
  trial.sets = system.allHeld();
  trial.sets.slip.assign(trial.sets.slip.size(), 1);
  const auto move = [&](Eigen::Index row, double by) {
    trial.force[row] += by;
    trial.motion += by * W.col(row);
  };
  std::vector<std::vector<Eigen::Index>> nodesOf(system.normals());
  for (size_t k = 0; k < node.size(); ++k) nodesOf[node[k]].push_back(static_cast<Eigen::Index>(k));
  int next = first;
  const double sweeps = std::clamp(work / static_cast<double>(W.size()), least, most);
  for (int sweep = 1; sweep <= sweeps; ++sweep) {
    stopIfInterrupted();
    trial.motion = system.q() + problem.W * trial.force - G * z;
    if (G.cols() > 0) {
      const Vector unbalanced = (system.springs().load - G.transpose() * trial.force) / stiffness;
      trial.motion -= G * unbalanced;
      z += unbalanced;
    }
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
    if (sweep < next) continue;
    next *= 2;
    std::optional<FrictionSolution> found = system.newton(system.next(trial));
    if (!found && G.cols() == 0) {
      trial.motion = system.q() + problem.W * trial.force;
      FrictionSolution swept = trial;
      swept.sets = system.next(trial);
      found = system.asSolution(std::move(swept));
    }
    if (found && found->index > 0) return found;
  }
  return std::nullopt;
}

}  // namespace mortier
