#include "solver/pivoting.h"

#include <Eigen/Eigenvalues>
#include <Eigen/LU>
#include <algorithm>
#include <cmath>
#include <limits>

#include "base/interrupt.h"

namespace mortier {
namespace {

/// Values below this part of the largest are rounding.
constexpr double rounding = 64 * std::numeric_limits<double>::epsilon();

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

Pivoting::Pivoting(const ContactProblem& problem, const std::vector<char>& idle, const Vector& slack,
                   const Vector& p0, const Vector& balance, Work& work)
    : problem_(problem),
      idle_(idle),
      slack_(slack),
      p0_(p0),
      balance_(balance),
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

void Pivoting::restart(const Vector& slack) {
  slack_ = slack;
  proximal_ = problem_.proximal * stiffness_;
  // Where a body has to travel until contact closes, weak enough that the load takes it there.
  constexpr double farther = 10;
  const double open = slack.size() > 0 ? slack.maxCoeff() : 0;
  const double load = (balance_ + problem_.G.transpose() * p0_).lpNorm<Eigen::Infinity>();
  if (open > 0 && load > 0) proximal_ = std::min(proximal_, load / (farther * open));
}

void Pivoting::soften() {
  proximal_ = std::max(softer * proximal_, std::min(proximal_, softest * stiffness_));
}

bool Pivoting::run(const Vector& z0, ContactSolution& solution) {
  constexpr size_t faster = 2;
  constexpr size_t slower = 4;
  const auto n = static_cast<int>(slack_.size());
  pivotsLeft_ = 20 * n + 100;
  Signs best;
  size_t atOnce = n;
  if (!dropPulls(z0, solution, best)) return false;
  while (!best.overlaps.empty()) {
    const std::vector<char> before = solution.active;
    const std::vector<int> chosen = deepest(best, atOnce);
    for (const int i : chosen) solution.active[i] = 1;
    Signs next;
    if (!dropPulls(z0, solution, next)) return false;
    if (isBetter(next, best)) {
      best = std::move(next);
      atOnce = faster * chosen.size();
      continue;
    }
    solution.active = before;
    atOnce = std::max<size_t>(1, chosen.size() / slower);
    if (chosen.size() > 1) continue;
    if (problem_.symmetric)
      descend(z0, chosen.front(), best.force, solution);
    else
      closeOne(z0, chosen.front(), solution);
    if (!dropPulls(z0, solution, best)) return false;
  }
  return true;
}

/// Drops forces that pull until none is left; where no overlap is either, with factors of the set itself.
bool Pivoting::dropPulls(const Vector& z0, ContactSolution& solution, Signs& signs) {
  while (!redundant_ && !capped()) {
    stopIfInterrupted();
    if (!solveOn(z0, solution)) return false;
    signs = signsOf(solution);
    for (const int i : signs.pulls) solution.active[i] = 0;
    if (!signs.pulls.empty()) continue;
    if (!signs.overlaps.empty() || factor_.fresh()) return true;
    redundant_ = !factor_.refactor(solution.active);
  }
  return false;
}

/// Whether sets on which no force pulls come nearer to the solution. Where W is symmetric that is by the energy
/// 1/2 p'W p + s0'p, whose change is half of s_old'p_new - s_new'p_old, otherwise by the number of overlaps.
bool Pivoting::isBetter(const Signs& next, const Signs& best) const {
  if (next.overlaps.empty()) return true;
  if (!problem_.symmetric) return next.overlaps.size() < best.overlaps.size();
  return best.slack.dot(next.force) < next.slack.dot(best.force);
}

Vector Pivoting::usualForces(const ContactSolution& solution) const {
  constexpr double roundingOfGaps = 1e-8;  // an imbalance of 1e-6 of that is rounding
  Vector usual = Vector::Constant(slack_.size(), problem_.force);
  const double largest = slack_.cwiseAbs().maxCoeff();
  for (Eigen::Index i = 0; i < usual.size(); ++i)
    if (solution.active[i] != 0 && idle_[i] == 0)
      usual[i] = std::max(usual[i], roundingOfGaps * largest / problem_.W(i, i));
  return usual;
}

double Pivoting::imbalance(const ContactSolution& solution, const Vector& usual) const {
  const Vector rest = balance_ - problem_.G.transpose() * solution.change;
  const Vector forces = p0_.cwiseAbs() + (p0_ + solution.change).cwiseAbs() + usual;
  const double scale =
      balance_.cwiseAbs().maxCoeff() + (problem_.G.cwiseAbs().transpose() * forces).maxCoeff();
  return scale > 0 ? rest.cwiseAbs().maxCoeff() / scale : 0;
}

bool Pivoting::leaves(const ContactSolution& solution) const {
  constexpr double negligible = 1e-6;
  const Vector closing = problem_.G * solution.rigid;
  const double work = (balance_ + problem_.G.transpose() * p0_).dot(solution.rigid);
  return closing.maxCoeff() <= negligible * closing.cwiseAbs().maxCoeff() && work > 0;
}

Vector Pivoting::compliance(const Vector& p) {
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

/// x_A and z of  W_AA x_A - G_A z = f_A,  G_A' x_A + proximal z = h.  \param f  becomes x, zero off A.
Vector Pivoting::solveBordered(const std::vector<char>& active, const Vector& h, Vector& f) {
  const Matrix& G = problem_.G;
  redundant_ = redundant_ || !factor_.take(active);
  Matrix solved(f.size(), 1 + G.cols());
  solved << f, G;
  factor_.solve(solved);
  f = solved.col(0);
  if (G.cols() == 0) return Vector(0);
  // Motions that move no condition of A have the proximal term alone, however weak it is beside the rounding of the others.
  constexpr double heldFraction = 1e-14;
  Matrix closed = G;
  for (Eigen::Index i = 0; i < closed.rows(); ++i)
    if (active[i] == 0) closed.row(i).setZero();
  const Eigen::SelfAdjointEigenSolver<Matrix> eigen(closed.transpose() * closed);
  const auto loose = (eigen.eigenvalues().array() <= heldFraction * G.squaredNorm()).count();
  const Matrix free = eigen.eigenvectors().leftCols(loose);
  const Matrix held = eigen.eigenvectors().rightCols(G.cols() - loose);
  // Rows off A are zero in what is solved.
  const Matrix forces = solved.rightCols(G.cols()) * held;
  Matrix stiffness = held.transpose() * G.transpose() * forces;
  stiffness.diagonal().array() += proximal_;
  const Vector z = stiffness.partialPivLu().solve(held.transpose() * (h - G.transpose() * f));
  f += forces * z;
  return held * z + free * (free.transpose() * h / proximal_);
}

/// p = 0 off the active set, s = 0 on it. \returns false where that is redundant.
bool Pivoting::solveOn(const Vector& z0, ContactSolution& solution) {
  ++solution.pivots;
  --pivotsLeft_;
  Vector off = -p0_;
  for (Eigen::Index i = 0; i < off.size(); ++i)
    if (solution.active[i] != 0) off[i] = 0;
  solution.change = -slack_ - compliance(off);
  solution.rigid = solveBordered(solution.active, balance_ - problem_.G.transpose() * off + proximal_ * z0,
                                 solution.change);
  solution.change += off;
  // Forces that a motion and a slack need by themselves may be far larger than those of both together: what rounding leaves of
  // that is solved for again while it becomes less.
  constexpr int corrections = 4;
  double before = INFINITY;
  for (int k = 0; !redundant_; ++k) {
    open_ = slackOf(solution);
    const double left = residual(solution);
    if (k == corrections || !(left > rounding * sizeOf(solution)) || !(left < before / 2)) break;
    before = left;
    Vector rest = -open_;
    const Vector unbalanced =
        balance_ - problem_.G.transpose() * solution.change - proximal_ * (solution.rigid - z0);
    solution.rigid += solveBordered(solution.active, unbalanced, rest);
    solution.change += rest;
  }
  return !redundant_;
}

/// Largest slack of closed conditions, as a force.
double Pivoting::residual(const ContactSolution& solution) const {
  double largest = 0;
  for (Eigen::Index i = 0; i < open_.size(); ++i)
    if (solution.active[i] != 0) largest = std::max(largest, std::abs(open_[i]) / problem_.W(i, i));
  return largest;
}

/// Forces of the size that the problem has.
double Pivoting::sizeOf(const ContactSolution& solution) const {
  double largest = 0;
  for (Eigen::Index i = 0; i < slack_.size(); ++i)
    if (idle_[i] == 0)
      largest = std::max({largest, std::abs(p0_[i] + solution.change[i]), std::abs(p0_[i]),
                          std::abs(slack_[i]) / problem_.W(i, i)});
  return largest;
}

Vector Pivoting::slackOf(const ContactSolution& solution) {
  Vector s = slack_ + compliance(solution.change);
  if (problem_.G.cols() > 0) s -= problem_.G * solution.rigid;
  return s;
}

/// Signs are judged against rounding, slacks as the forces that would close them.
Pivoting::Signs Pivoting::signsOf(const ContactSolution& solution) {
  Signs signs{open_, p0_ + solution.change, {}, {}};
  Vector& s = signs.slack;
  Vector& p = signs.force;
  const double largest = sizeOf(solution);
  const Vector depth = s.cwiseQuotient(problem_.W.diagonal());
  const double noise = std::max(rounding * largest, 2 * residual(solution));
  for (Eigen::Index i = 0; i < s.size(); ++i) {
    if (idle_[i] != 0) continue;
    if (solution.active[i] != 0 && !(p[i] >= -rounding * largest)) signs.pulls.push_back(static_cast<int>(i));
    if (solution.active[i] == 0 && !(depth[i] >= -noise)) signs.overlaps.push_back(static_cast<int>(i));
  }
  for (Eigen::Index i = 0; i < s.size(); ++i) {
    if (solution.active[i] != 0) s[i] = 0;
    p[i] = std::max(p[i], 0.0);
  }
  return signs;
}

/// Of each run of neighbours that overlap the deepest: closing all would make most of them pull. At most `count`, the deepest
/// ones.
std::vector<int> Pivoting::deepest(const Signs& signs, size_t count) const {
  const Vector depth = signs.slack.cwiseQuotient(problem_.W.diagonal());
  std::vector<int> result;
  for (size_t k = 0; k < signs.overlaps.size(); ++k) {
    const int i = signs.overlaps[k];
    if (k == 0 || i != signs.overlaps[k - 1] + 1)
      result.push_back(i);
    else if (depth[i] < depth[result.back()])
      result.back() = i;
  }
  if (result.size() <= count) return result;
  std::nth_element(result.begin(), result.begin() + static_cast<std::ptrdiff_t>(count), result.end(),
                   [&](int a, int b) { return std::pair(depth[a], a) < std::pair(depth[b], b); });
  result.resize(count);
  return result;
}

/// Closes an overlap of a set on which the forces p push; of those that would pull, the one that is reached first is dropped,
/// and so on: the energy falls (Lawson and Hanson 1974).
void Pivoting::descend(const Vector& z0, int chosen, Vector p, ContactSolution& solution) {
  solution.active[chosen] = 1;
  while (!capped()) {
    stopIfInterrupted();
    if (!solveOn(z0, solution)) return;
    const Vector towards = p0_ + solution.change - p;
    double length = 1;
    int first = -1;
    for (int i = 0; i < p.size(); ++i) {
      if (solution.active[i] == 0 || !(p[i] + length * towards[i] < 0)) continue;
      length = -p[i] / towards[i];
      first = i;
    }
    if (first < 0) return;
    p = (p + length * towards).cwiseMax(0);
    p[first] = 0;
    solution.active[first] = 0;
  }
}

/// Closes an overlap of a set whose forces all push; no sign that is right becomes wrong.
void Pivoting::closeOne(const Vector& z0, int chosen, ContactSolution& solution) {
  if (!solveOn(z0, solution)) return;
  Vector p = p0_ + solution.change;
  Vector s = open_;
  const auto diagonal = problem_.W.diagonal();
  while (!capped()) {
    stopIfInterrupted();
    ++solution.pivots;
    --pivotsLeft_;
    Vector rate = -problem_.W.col(chosen);
    const Vector motion = solveBordered(solution.active, -problem_.G.row(chosen).transpose(), rate);
    if (redundant_) return;
    rate[chosen] = 1;
    Vector opening = compliance(rate);
    if (motion.size() > 0) opening -= problem_.G * motion;
    const double least = rounding * std::max(rate.cwiseAbs().maxCoeff(),
                                             opening.cwiseQuotient(diagonal).cwiseAbs().maxCoeff());
    double length = opening[chosen] > 0 ? -s[chosen] / opening[chosen] : INFINITY;
    int next = chosen;
    for (int i = 0; i < p.size(); ++i) {
      if (i == chosen || idle_[i] != 0) continue;
      const bool active = solution.active[i] != 0;
      const double fall = active ? -rate[i] : -opening[i] / diagonal[i];
      const double value = active ? p[i] : s[i] / diagonal[i];
      if (!(fall > least) || (!active && value < 0) || !(std::max(value, 0.0) < length * fall)) continue;
      length = std::max(value, 0.0) / fall;
      next = i;
    }
    if (!std::isfinite(length)) return;
    p += length * rate;
    s += length * opening;
    solution.active[next] = solution.active[next] != 0 ? 0 : 1;
    if (next == chosen) return;
    (solution.active[next] != 0 ? s : p)[next] = 0;
  }
}

}  // namespace mortier
