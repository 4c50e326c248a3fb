#include "solver/friction_motions.h"

#include <algorithm>
#include <utility>

#include "solver/contact_sets.h"
#include "solver/friction_solutions.h"

namespace mortier {

LooseFriction solveLooseFriction(const Matrix& W, const FrictionRows& rows, const Matrix& G,
                                 const Vector& load, double usual, double weight, Vector q,
                                 FrictionSets first, bool listAll) {
  constexpr int repetitions = 15;
  constexpr double balanced = 1e-14;
  constexpr double slow = 1e-12;  // three repetitions leave no more, unless the springs are too strong
  constexpr double softer = 1e-2;
  constexpr double softest = 1e-4;  // of the springs to begin with
  constexpr double farther = 10;
  constexpr double mostImbalance = 1e-9;
  constexpr double roundingOfGaps = 1e-5;  // an imbalance of 1e-9 of that is rounding

  // What rigid motions take away is taken first, as in solveContact.
  std::vector<char> closed = first.closed;
  for (size_t k = 0; k < rows.node.size(); ++k)
    closed.push_back(first.slip[k] == 0 && first.closed[rows.node[k]] != 0 ? 1 : 0);
  const Vector moved = moveRigidBodiesIntoContact(G, closed, q);
  FreeMotions motions{G, load, Vector::Zero(G.cols())};
  motions.stiffness = G.squaredNorm() / W.diagonal().maxCoeff();
  motions.spring = weight * motions.stiffness;
  const double force = load.lpNorm<Eigen::Infinity>();
  const double open = q.head(W.rows() - static_cast<Eigen::Index>(rows.node.size())).maxCoeff();
  if (open > 0 && force > 0) motions.spring = std::min(motions.spring, force / (farther * open));
  const double least = softest * motions.spring;

  LooseFriction result;
  int solves = 0;
  int events = 0;
  bool ambiguous = false;
  double imbalance = 0;
  double beside = 0;
  Vector change;
  for (int repetition = 0; repetition < repetitions; ++repetition) {
    result.solution = solveFriction({W, rows, &motions}, q, first);
    solves += result.solution.solves;
    events += result.solution.events;
    ambiguous = ambiguous || result.solution.ambiguous;
    if (!result.solution.solved) return result;
    first = result.solution.sets;
    change = result.solution.rigid - motions.z0;
    motions.z0 = result.solution.rigid;
    const Vector& x = result.solution.force;
    imbalance = (load - G.transpose() * x).lpNorm<Eigen::Infinity>();
    const Matrix size = G.cwiseAbs().transpose();
    beside = force + (size * x.cwiseAbs()).maxCoeff();
    if (imbalance <= balanced * beside) break;
    if (repetition > 1 && imbalance > slow * beside)
      motions.spring = std::max(softer * motions.spring, least);
  }
  usual += roundingOfGaps * q.lpNorm<Eigen::Infinity>() / W.diagonal().maxCoeff();
  const double all = beside + usual * G.cwiseAbs().colwise().sum().maxCoeff();
  result.solution.solves = solves;
  result.solution.events = events;
  result.solution.ambiguous = ambiguous;
  result.balanced = imbalance <= mostImbalance * all;
  if (listAll && result.balanced) result.all = solutionsOnPath({W, rows, &motions}, q, result.solution);
  result.rigid = result.balanced ? Vector(result.solution.rigid + moved) : change;
  return result;
}

}  // namespace mortier
