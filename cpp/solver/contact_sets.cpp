#include "solver/contact_sets.h"

#include <algorithm>
#include <cmath>
#include <utility>

#include "base/dense_templates.h"

namespace mortier {

ContactSets::ContactSets(const ContactProblem& problem, const std::vector<char>& idle, Vector diagonal,
                         Vector slack, const Vector& p0, const Vector& balance)
    : problem_(problem),
      idle_(idle),
      diagonal_(std::move(diagonal)),
      slack_(std::move(slack)),
      p0_(p0),
      balance_(balance),
      z0_(Vector::Zero(balance.size())) {}

void ContactSets::setProximalPoint(const Vector& z0) {
  z0_ = z0;
  pivotsLeft_ = 20 * static_cast<int>(slack_.size()) + 100;
}

void ContactSets::soften() {
  weight_ = std::max(softer * weight_, std::min(weight_, weakest_));
}

bool ContactSets::solveOn(ContactSolution& solution) {
  ++solution.pivots;
  --pivotsLeft_;
  if (!take(solution.active)) return false;
  solveTaken(solution);
  return true;
}

bool ContactSets::grow(int condition, ContactSolution& solution, Growth& growth) {
  ++solution.pivots;
  --pivotsLeft_;
  if (!take(solution.active)) return false;
  growTaken(condition, growth);
  return true;
}

ContactSets::Violations ContactSets::violationsOf(const ContactSolution& solution) const {
  Violations violations{open_, p0_ + solution.change, {}, {}};
  Vector& s = violations.slack;
  Vector& p = violations.force;
  const Vector depth = s.cwiseQuotient(diagonal_);
  const Noise least = noise(solution);
  for (Eigen::Index i = 0; i < s.size(); ++i) {
    if (idle_[i] != 0) continue;
    if (solution.active[i] != 0 && !(p[i] >= -least.force)) violations.tension.push_back(static_cast<int>(i));
    if (solution.active[i] == 0 && !(depth[i] >= -least.depth[i]))
      violations.penetration.push_back(static_cast<int>(i));
  }
  for (Eigen::Index i = 0; i < s.size(); ++i) {
    if (solution.active[i] != 0) s[i] = 0;
    p[i] = std::max(p[i], 0.0);
  }
  return violations;
}

double ContactSets::residual(const ContactSolution& solution) const {
  double largest = 0;
  for (Eigen::Index i = 0; i < open_.size(); ++i)
    if (solution.active[i] != 0) largest = std::max(largest, std::abs(open_[i]) / diagonal_[i]);
  return largest;
}

double ContactSets::sizeOf(const ContactSolution& solution) const {
  double largest = 0;
  for (Eigen::Index i = 0; i < slack_.size(); ++i)
    if (idle_[i] == 0)
      largest = std::max({largest, std::abs(p0_[i] + solution.change[i]), std::abs(p0_[i]),
                          solution.active[i] != 0 ? std::abs(slack_[i]) / diagonal_[i] : 0});
  return largest;
}

Vector ContactSets::forceScales(const ContactSolution& solution) const {
  constexpr double roundingOfGaps = 1e-8;  // an imbalance of 1e-6 of that is rounding
  Vector scales = Vector::Constant(slack_.size(), problem_.forceScale);
  const double largest = slack_.cwiseAbs().maxCoeff();
  for (Eigen::Index i = 0; i < scales.size(); ++i)
    if (solution.active[i] != 0 && idle_[i] == 0)
      scales[i] = std::max(scales[i], roundingOfGaps * largest / diagonal_[i]);
  return scales;
}

double ContactSets::imbalance(const ContactSolution& solution, const Vector& scales) const {
  const Vector rest = balance_ - problem_.G.transpose() * solution.change;
  const Vector forces = p0_.cwiseAbs() + (p0_ + solution.change).cwiseAbs() + scales;
  const double scale =
      balance_.cwiseAbs().maxCoeff() + (problem_.G.cwiseAbs().transpose() * forces).maxCoeff();
  return scale > 0 ? rest.cwiseAbs().maxCoeff() / scale : 0;
}

bool ContactSets::isUnbounded(const ContactSolution& solution) const {
  constexpr double negligible = 1e-6;
  const Vector z = rigid(solution);
  const Vector closing = problem_.G * z;
  const double work = (balance_ + problem_.G.transpose() * p0_).dot(z);
  return closing.maxCoeff() <= negligible * closing.cwiseAbs().maxCoeff() && work > 0;
}

double proximalStiffness(double stiffness, double load, double open) {
  constexpr double farther = 10;  // than the gap
  return open > 0 && load > 0 ? std::min(stiffness, load / (farther * open)) : stiffness;
}

RigidMotions rigidMotionsOn(const std::vector<char>& active, const Matrix& G) {
  if (G.cols() == 0) return {Matrix(0, 0), Matrix(0, 0)};
  // Those that move no condition have the proximal term alone,
  // however weak it is beside the rounding of the others.
  constexpr double heldFraction = 1e-14;
  Matrix closed = G;
  for (Eigen::Index i = 0; i < closed.rows(); ++i)
    if (active[i] == 0) closed.row(i).setZero();
  const Eigen::SelfAdjointEigenSolver<Matrix> eigen(Matrix(closed.transpose() * closed));
  const auto free = (eigen.eigenvalues().array() <= heldFraction * G.squaredNorm()).count();
  return {eigen.eigenvectors().rightCols(G.cols() - free), eigen.eigenvectors().leftCols(free)};
}

Vector moveRigidBodiesIntoContact(const Matrix& G, const std::vector<char>& active, Vector& slack) {
  if (G.cols() == 0 || slack.size() == 0) return Vector::Zero(G.cols());
  std::vector<Eigen::Index> closed;
  for (Eigen::Index i = 0; i < slack.size(); ++i)
    if (active[i] != 0) closed.push_back(i);
  const bool none = closed.empty();
  const Matrix motions = none ? G : Matrix(G(closed, Eigen::all));
  Vector moved = motions.completeOrthogonalDecomposition().solve(none ? slack : Vector(slack(closed)));
  slack -= G * moved;
  return moved;
}

std::vector<char> idleConditions(const Vector& diagonal) {
  constexpr double negligible = 1e-24;  // W is quadratic in the rows of C
  std::vector<char> idle(diagonal.size(), 0);
  const double largest = diagonal.size() > 0 ? diagonal.cwiseAbs().maxCoeff() : 0;
  for (Eigen::Index i = 0; i < diagonal.size(); ++i)
    idle[i] = std::abs(diagonal[i]) <= negligible * largest ? 1 : 0;
  return idle;
}

}  // namespace mortier
