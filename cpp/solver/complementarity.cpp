#include "solver/complementarity.h"

#include <algorithm>
#include <cmath>

#include "base/interrupt.h"
#include "solver/proximal_contact.h"

namespace mortier {
namespace {

/// Conditions that say the same twice leave the forces undetermined and W singular: a proximal term on dp
/// makes it regular, repeated until it no longer acts.
/// \param weight  of the term. The smaller, the fewer repetitions, and the more rounding in the signs of
/// forces.
ContactSolution solveRedundant(const ContactProblem& problem, const std::vector<char>& idle,
                               const Vector& slack, const Vector& p0, const Vector& balance,
                               const std::vector<char>& active, double weight, Work& work) {
  constexpr int repetitions = 40;
  constexpr double done = 1e-15;
  ContactProblem regular = problem;
  const Vector term = weight * problem.W.diagonal();
  regular.W.diagonal() += term;
  ProximalContact contact(regular, idle, slack, p0, balance, work);
  ContactSolution solution;
  solution.active = active;
  Vector before = Vector::Zero(slack.size());
  int pivots = 0;
  const auto solve = [&] {
    contact.restart(slack - term.cwiseProduct(before));
    solution = solveBalanced(contact, solution.active);
    pivots += solution.pivots;
    if (solution.outcome != ContactSolution::Outcome::solved) return 0.0;
    const double carried = term.cwiseProduct(solution.change - before).lpNorm<Eigen::Infinity>();
    const Vector forces = p0.cwiseAbs() + solution.change.cwiseAbs();
    before = solution.change;
    return ratio(carried, problem.W.diagonal().cwiseProduct(forces).maxCoeff());
  };
  repeatProximal(repetitions, done, solve);
  solution.pivots = pivots;
  return solution;
}

}  // namespace

int dependentConditions(const Matrix& W) {
  constexpr double singular = 1e-12;  // as in ActiveFactor
  const std::vector<char> idle = idleConditions(W.diagonal());
  const auto idles = static_cast<Eigen::Index>(std::count(idle.begin(), idle.end(), 1));
  // Columns made orthogonal to the longest one that is left, until none is: in steps that can be interrupted.
  Matrix rest = W;
  Eigen::Index rank = 0;
  double largest = 0;
  for (; rank < W.rows(); ++rank) {
    stopIfInterrupted();
    Eigen::Index longest = 0;
    const double length = std::sqrt(rest.colwise().squaredNorm().maxCoeff(&longest));
    largest = std::max(largest, length);
    if (!(length > singular * largest)) break;
    const Vector q = rest.col(longest) / length;
    const Eigen::RowVectorXd along = q.transpose() * rest;
    rest.noalias() -= q * along;
    rest.col(longest).setZero();
  }
  return static_cast<int>(W.rows() - idles - rank);
}

ContactSolution solveContact(const ContactProblem& problem, const Vector& fullSlack, const Vector& p0,
                             const Vector& balance, std::vector<char> active) {
  Vector slack = fullSlack;
  const Vector moved = moveRigidBodiesIntoContact(problem.G, active, slack);
  if (slack.size() == 0) {
    ContactSolution solution;
    solution.change = p0;
    solution.rigid = Vector::Zero(problem.G.cols());
    solution.outcome = ContactSolution::Outcome::solved;
    return solution;
  }
  Work work(problem);
  const std::vector<char> idle = idleConditions(problem.W.diagonal());
  for (size_t i = 0; i < idle.size(); ++i)
    if (idle[i] != 0) active[i] = 0;
  const auto idles = static_cast<int>(std::count(idle.begin(), idle.end(), 1));
  // Without forces to begin with, what overlaps without any may close.
  if (problem.G.cols() == 0 && p0.isZero(0) && std::count(active.begin(), active.end(), 0) == idles)
    for (size_t i = 0; i < idle.size(); ++i)
      active[i] = idle[i] == 0 && slack[static_cast<Eigen::Index>(i)] < 0 ? 1 : 0;
  ContactSolution solution;
  int pivots = 0;
  bool dependent = false;
  if (idles == 0 || problem.G.cols() == 0) {
    ProximalContact contact(problem, idle, slack, p0, balance, work);
    solution = solveBalanced(contact, active);
    dependent = contact.redundant();
    pivots = solution.pivots;
  }
  if (dependent || (idles > 0 && problem.G.cols() > 0)) {
    ContactProblem regular = problem;
    for (size_t i = 0; i < idle.size(); ++i)
      if (idle[i] != 0) regular.W(i, i) = problem.W.diagonal().maxCoeff();
    for (const double weight : {1e-9, 1e-8, 1e-7}) {
      solution = solveRedundant(regular, idle, slack, p0, balance, active, weight, work);
      pivots += solution.pivots;
      if (solution.outcome != ContactSolution::Outcome::cycled) break;
    }
  }
  // The motion along which bodies leave is found without it.
  if (solution.outcome != ContactSolution::Outcome::unbalanced) solution.rigid += moved;
  solution.pivots = pivots;
  solution.idle = idles;
  solution.dependent = dependent;
  solution.work = work.done / work.factorisation;
  return solution;
}

}  // namespace mortier
