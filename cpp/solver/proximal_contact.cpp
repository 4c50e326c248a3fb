#include "solver/proximal_contact.h"

#include <Eigen/Eigenvalues>
#include <algorithm>
#include <cmath>

namespace mortier {
namespace {

/// How a proximal term is weakened from one repetition to the next, and down to which weight.
constexpr double softer = 1e-2;
constexpr double softest = 1e-13;

}  // namespace

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
  proximal_ = problem_.proximal * stiffness_;
  // Where a body has to travel until contact closes, weak enough that the load takes it there.
  constexpr double farther = 10;
  const double open = slack.size() > 0 ? slack.maxCoeff() : 0;
  const double load = (balance_ + problem_.G.transpose() * p0_).lpNorm<Eigen::Infinity>();
  if (open > 0 && load > 0) proximal_ = std::min(proximal_, load / (farther * open));
}

void ProximalContact::centre(const Vector& z0) {
  z0_ = z0;
  pivotsLeft_ = 20 * static_cast<int>(slack_.size()) + 100;
}

void ProximalContact::soften() {
  proximal_ = std::max(softer * proximal_, std::min(proximal_, softest * stiffness_));
}

bool ProximalContact::solveOn(ContactSolution& solution) {
  ++solution.pivots;
  --pivotsLeft_;
  if (!take(solution.active)) return false;
  Vector off = -p0_;
  for (Eigen::Index i = 0; i < off.size(); ++i)
    if (solution.active[i] != 0) off[i] = 0;
  solution.change = -slack_ - compliance(off);
  solution.rigid = solve(balance_ - problem_.G.transpose() * off + proximal_ * z0_, solution.change);
  solution.change += off;
  // The forces that a slack needs by itself, and those of a motion, may be far larger than both together.
  // What rounding leaves of them is solved for again while it becomes less.
  constexpr int corrections = 4;
  double before = INFINITY;
  for (int k = 0;; ++k) {
    open_ = slack_ + compliance(solution.change);
    if (problem_.G.cols() > 0) open_ -= problem_.G * solution.rigid;
    const double left = residual(solution);
    if (k == corrections || !(left > rounding * sizeOf(solution)) || !(left < before / 2)) return true;
    before = left;
    Vector rest = -open_;
    const Vector unbalanced =
        balance_ - problem_.G.transpose() * solution.change - proximal_ * (solution.rigid - z0_);
    solution.rigid += solve(unbalanced, rest);
    solution.change += rest;
  }
}

bool ProximalContact::grow(int condition, ContactSolution& solution, Growth& growth) {
  ++solution.pivots;
  --pivotsLeft_;
  if (!take(solution.active)) return false;
  growth.force = -problem_.W.col(condition);
  // A row of a matrix without columns has no address.
  const Vector drive = problem_.G.cols() > 0 ? Vector(-problem_.G.row(condition).transpose()) : Vector();
  const Vector motion = solve(drive, growth.force);
  growth.force[condition] = 1;
  growth.slack = compliance(growth.force);
  if (motion.size() > 0) growth.slack -= problem_.G * motion;
  return true;
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

/// Factors of W_AA and of  G_A' W_AA^-1 G_A + proximal.
bool ProximalContact::take(const std::vector<char>& active) {
  const Matrix& G = problem_.G;
  redundant_ = redundant_ || !factor_.take(active);
  if (G.cols() == 0 || redundant_) return !redundant_;
  forces_ = G;
  factor_.solve(forces_);
  // Motions that move no condition of A have the proximal term alone,
  // however weak it is beside the rounding of the others.
  constexpr double heldFraction = 1e-14;
  Matrix closed = G;
  for (Eigen::Index i = 0; i < closed.rows(); ++i)
    if (active[i] == 0) closed.row(i).setZero();
  const Eigen::SelfAdjointEigenSolver<Matrix> eigen(closed.transpose() * closed);
  const auto loose = (eigen.eigenvalues().array() <= heldFraction * G.squaredNorm()).count();
  free_ = eigen.eigenvectors().leftCols(loose);
  held_ = eigen.eigenvectors().rightCols(G.cols() - loose);
  forces_ *= held_;
  Matrix stiffness = held_.transpose() * G.transpose() * forces_;
  stiffness.diagonal().array() += proximal_;
  stiffnessFactor_.compute(stiffness);
  return true;
}

/// x_A and z of  W_AA x_A - G_A z = f_A,  G_A' x_A + proximal z = h.  \param f  becomes x, zero off A.
Vector ProximalContact::solve(const Vector& h, Vector& f) {
  Matrix x = f;
  factor_.solve(x);
  f = x;
  if (problem_.G.cols() == 0) return Vector(0);
  const Vector z = stiffnessFactor_.solve(held_.transpose() * (h - problem_.G.transpose() * f));
  f += forces_ * z;  // rows off A are zero
  return held_ * z + free_ * (free_.transpose() * h / proximal_);
}

}  // namespace mortier
