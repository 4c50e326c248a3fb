#include "solver/proximal_contact.h"

#include <algorithm>
#include <cmath>

#include "base/dense_templates.h"

namespace mortier {

Work::Work(const ContactProblem& problem) {
  constexpr double alwaysAllowed = 1e8;  // small problems end by the number of their pivots
  const auto n = static_cast<double>(problem.W.rows());
  factorisation = n * n * n / (problem.symmetric ? 3 : 1.5);
  limit = workLimit * factorisation + alwaysAllowed;
}

ProximalContact::ProximalContact(const ContactProblem& problem, const std::vector<char>& idle,
                                 const Vector& slack, const Vector& p0, const Vector& balance, Work& work)
    : ContactSets(problem, idle, problem.W.diagonal(), slack, p0, balance),
      work_(work),
      factor_(problem.W, problem.symmetric, work.done) {
  // The proximal weight against the stiffness that all nodes together give to rigid motions.
  if (problem.G.cols() == 0) return;
  redundant_ = !factor_.take(std::vector<char>(slack.size(), 1));
  if (redundant_) return;
  Matrix solved = problem.G;
  factor_.solve(solved);
  stiffness_ = (problem.G.transpose() * solved).diagonal().maxCoeff();
  restart(slack);
}

void ProximalContact::restart(const Vector& slack) {
  slack_ = slack;
  const double load = (balance_ + problem_.G.transpose() * p0_).lpNorm<Eigen::Infinity>();
  weight_ = proximalStiffness(problem_.proximal * stiffness_, load, slack.size() > 0 ? slack.maxCoeff() : 0);
  weakest_ = weakestProximal * stiffness_;
}

void ProximalContact::solveTaken(ContactSolution& solution) {
  Vector off = -p0_;
  for (Eigen::Index i = 0; i < off.size(); ++i)
    if (solution.active[i] != 0) off[i] = 0;
  solution.change = -slack_ - compliance(off);
  solution.rigid = solve(balance_ - problem_.G.transpose() * off + weight_ * z0_, solution.change);
  solution.change += off;
  // The forces that a slack needs by itself, and those of a motion, may be far larger than both together.
  // What rounding leaves of them is solved for again while it becomes less.
  constexpr int corrections = 4;
  double before = INFINITY;
  for (int k = 0;; ++k) {
    open_ = slack_ + compliance(solution.change);
    if (problem_.G.cols() > 0) open_ -= problem_.G * solution.rigid;
    const double left = residual(solution);
    if (k == corrections || !(left > rounding * sizeOf(solution)) || !(left < before / 2)) return;
    before = left;
    Vector rest = -open_;
    const Vector unbalanced =
        balance_ - problem_.G.transpose() * solution.change - weight_ * (solution.rigid - z0_);
    solution.rigid += solve(unbalanced, rest);
    solution.change += rest;
  }
}

void ProximalContact::growTaken(int condition, Growth& growth) {
  growth.force = -problem_.W.col(condition);
  // A row of a matrix without columns has no address.
  const Vector drive = problem_.G.cols() > 0 ? Vector(-problem_.G.row(condition).transpose()) : Vector();
  const Vector motion = solve(drive, growth.force);
  growth.force[condition] = 1;
  growth.slack = compliance(growth.force);
  if (motion.size() > 0) growth.slack -= problem_.G * motion;
}

bool ProximalContact::refactor(const std::vector<char>& active) {
  redundant_ = redundant_ || (!factor_.fresh() && !factor_.refactor(active));
  return !redundant_;
}

ContactSets::Noise ProximalContact::noise(const ContactSolution& solution) const {
  const double least = rounding * sizeOf(solution);
  Vector depth = rounding * slack_.cwiseAbs().cwiseQuotient(diagonal_);
  return {least, depth.cwiseMax(std::max(least, 2 * residual(solution)))};
}

Vector ProximalContact::compliance(const Vector& p) {
  // Four columns at a time: each reads and writes the sum once.
  const Matrix& W = problem_.W;
  std::vector<Eigen::Index> loaded;
  for (Eigen::Index i = 0; i < p.size(); ++i)
    if (p[i] != 0) loaded.push_back(i);
  work_.done += 2 * static_cast<double>(W.rows()) * static_cast<double>(loaded.size());
  Vector sum = Vector::Zero(p.size());
  size_t k = 0;
  for (; k + 4 <= loaded.size(); k += 4) {
    const Eigen::Index* j = &loaded[k];
    sum += p[j[0]] * W.col(j[0]) + p[j[1]] * W.col(j[1]) + p[j[2]] * W.col(j[2]) + p[j[3]] * W.col(j[3]);
  }
  for (; k < loaded.size(); ++k) sum += p[loaded[k]] * W.col(loaded[k]);
  return sum;
}

/// Factors of W_AA and of  G_A' W_AA^-1 G_A + weight.
bool ProximalContact::take(const std::vector<char>& active) {
  const Matrix& G = problem_.G;
  redundant_ = redundant_ || !factor_.take(active);
  if (G.cols() == 0 || redundant_) return !redundant_;
  forces_ = G;
  factor_.solve(forces_);
  motions_ = rigidMotionsOn(active, G);
  forces_ *= motions_.held;
  Matrix stiffness = motions_.held.transpose() * G.transpose() * forces_;
  stiffness.diagonal().array() += weight_;
  stiffnessFactor_.compute(stiffness);
  return true;
}

/// x_A and z of  W_AA x_A - G_A z = f_A,  G_A' x_A + weight z = h.  \param f  becomes x, zero off A.
Vector ProximalContact::solve(const Vector& h, Vector& f) {
  Matrix x = f;
  factor_.solve(x);
  f = x;
  if (problem_.G.cols() == 0) return Vector(0);
  const Vector z = stiffnessFactor_.solve(motions_.held.transpose() * (h - problem_.G.transpose() * f));
  f += forces_ * z;  // rows off A are zero
  return motions_.held * z + motions_.free * (motions_.free.transpose() * h / weight_);
}

}  // namespace mortier
