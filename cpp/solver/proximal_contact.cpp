#include "solver/proximal_contact.h"

#include <algorithm>
#include <utility>

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

namespace {

/// A pivot below this fraction of its value before elimination is rounding.
constexpr double singular = 1e-12;

/// Sets smaller than this are factorised anew: updates would cost as much.
constexpr int smallSet = 48;

/// The border grows up to this part of the base.
constexpr int partOfBase = 8;

}  // namespace

ActiveFactor::ActiveFactor(const Matrix& W, bool symmetric, double& work)
    : W_(W),
      symmetric_(symmetric),
      unit_(W.size() > 0 ? W.diagonal().cwiseAbs().maxCoeff() : 0),
      placeOf_(W.rows(), -1),
      bordered_(W.rows(), 0),
      work_(work) {}

bool ActiveFactor::refactor(const std::vector<char>& active) {
  border_.clear();
  std::fill(bordered_.begin(), bordered_.end(), 0);
  base_.clear();
  for (size_t i = 0; i < active.size(); ++i) {
    placeOf_[i] = active[i] != 0 ? static_cast<int>(base_.size()) : -1;
    if (active[i] != 0) base_.push_back(static_cast<int>(i));
  }
  if (factoriseBase()) return true;
  base_.clear();
  std::fill(placeOf_.begin(), placeOf_.end(), -1);
  return false;
}

bool ActiveFactor::factoriseBase() {
  const auto n = static_cast<Eigen::Index>(base_.size());
  factor_.clear();
  if (n == 0) return true;
  Matrix block(n, n);
  for (Eigen::Index j = 0; j < n; ++j)
    for (Eigen::Index i = symmetric_ ? j : 0; i < n; ++i) block(i, j) = W_(base_[i], base_[j]);
  const double cube = static_cast<double>(n) * static_cast<double>(n) * static_cast<double>(n);
  work_ += cube / (symmetric_ ? 3 : 1.5);
  return factor_.factorise(std::move(block), symmetric_) && factor_.leastPivot() > singular;
}

void ActiveFactor::solveBase(Matrix& x) {
  work_ += 2 * static_cast<double>(factor_.rows() * factor_.rows()) * static_cast<double>(x.cols());
  factor_.solve(x);
}

/// The condition's row of the bordered matrix over B.
Vector ActiveFactor::rowOfBorder(int condition) const {
  if (placeOf_[condition] < 0) {
    if (symmetric_) return W_.col(condition)(base_);
    return W_.row(condition)(base_).transpose();
  }
  Vector row = Vector::Zero(static_cast<Eigen::Index>(base_.size()));
  row[placeOf_[condition]] = unit_;
  return row;
}

/// All at once: one by one, each solve would read the factors anew.
void ActiveFactor::insert(const std::vector<int>& conditions) {
  const auto n = static_cast<Eigen::Index>(base_.size());
  const auto k = static_cast<Eigen::Index>(border_.size());
  const auto count = static_cast<Eigen::Index>(conditions.size());
  if (count == 0) return;
  if (rows_.rows() != n || rows_.cols() < k + count) {
    const Eigen::Index room = std::max(k + count, n / partOfBase + 1);
    rows_.conservativeResize(n, room);
    solved_.conservativeResize(n, room);
    schur_.conservativeResize(room, room);
  }
  Matrix columns(n, count);
  for (Eigen::Index c = 0; c < count; ++c) {
    const int condition = conditions[c];
    rows_.col(k + c) = rowOfBorder(condition);
    columns.col(c) = placeOf_[condition] < 0 ? Vector(W_.col(condition)(base_)) : Vector(rows_.col(k + c));
    border_.push_back(condition);
    bordered_[condition] = 1;
  }
  solveBase(columns);
  solved_.middleCols(k, count) = columns;
  schur_.block(0, k, k + count, count).noalias() = -rows_.leftCols(k + count).transpose() * columns;
  schur_.block(k, 0, count, k).noalias() = -rows_.middleCols(k, count).transpose() * solved_.leftCols(k);
  work_ += 2 * static_cast<double>(n) * static_cast<double>(count) * static_cast<double>(2 * k + count);
  for (Eigen::Index j = k; j < k + count; ++j) {
    if (placeOf_[border_[j]] >= 0) continue;
    for (Eigen::Index i = 0; i <= j; ++i) {
      if (placeOf_[border_[i]] >= 0) continue;
      schur_(i, j) += W_(border_[i], border_[j]);
      if (i < j) schur_(j, i) += W_(border_[j], border_[i]);
    }
  }
}

void ActiveFactor::remove(int place) {
  const auto last = static_cast<Eigen::Index>(border_.size()) - 1;
  bordered_[border_[place]] = 0;
  border_[place] = border_[last];
  border_.pop_back();
  if (place == last) return;
  rows_.col(place) = rows_.col(last);
  solved_.col(place) = solved_.col(last);
  schur_.col(place).head(last + 1) = schur_.col(last).head(last + 1).eval();
  schur_.row(place).head(last + 1) = schur_.row(last).head(last + 1).eval();
}

bool ActiveFactor::take(const std::vector<char>& active) {
  std::vector<int> changed;
  int size = 0;
  for (size_t i = 0; i < active.size(); ++i) {
    size += active[i] != 0 ? 1 : 0;
    if ((active[i] != 0) != (placeOf_[i] >= 0)) changed.push_back(static_cast<int>(i));
  }
  if (changed.empty() && border_.empty()) return true;
  if (size < smallSet || partOfBase * changed.size() > base_.size()) return refactor(active);
  for (int place = static_cast<int>(border_.size()); place-- > 0;)
    if ((active[border_[place]] != 0) == (placeOf_[border_[place]] >= 0)) remove(place);
  std::erase_if(changed, [&](int condition) { return bordered_[condition] != 0; });
  insert(changed);
  const auto k = static_cast<Eigen::Index>(border_.size());
  if (k == 0) return true;
  const Matrix schur = schur_.topLeftCorner(k, k);
  schurFactor_.compute(schur);
  work_ += 2.0 / 3 * static_cast<double>(k) * static_cast<double>(k) * static_cast<double>(k);
  // Close to singular: factors of the set itself decide.
  constexpr double doubtful = 1e-9;
  if (!(schurFactor_.matrixLU().diagonal().cwiseAbs().minCoeff() > doubtful * unit_)) return refactor(active);
  return true;
}

void ActiveFactor::solve(Matrix& right) {
  if (base_.empty()) {
    right.setZero();
    return;
  }
  const auto k = static_cast<Eigen::Index>(border_.size());
  Matrix x = right(base_, Eigen::all);
  Matrix y(k, right.cols());
  for (Eigen::Index i = 0; i < k; ++i) {
    const int place = placeOf_[border_[i]];
    y.row(i).setZero();
    if (place >= 0)
      x.row(place).setZero();
    else
      y.row(i) = right.row(border_[i]);
  }
  solveBase(x);
  if (k > 0) {
    y -= rows_.leftCols(k).transpose() * x;
    y = schurFactor_.solve(y).eval();
    x -= solved_.leftCols(k) * y;
    work_ += 4 * static_cast<double>(x.size()) * static_cast<double>(k);
  }
  right.setZero();
  right(base_, Eigen::all) = x;
  for (Eigen::Index i = 0; i < k; ++i) {
    if (placeOf_[border_[i]] < 0)
      right.row(border_[i]) = y.row(i);
    else
      right.row(border_[i]).setZero();
  }
}

}  // namespace mortier
