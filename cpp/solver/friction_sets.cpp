#include "solver/friction_sets.h"

#include <algorithm>
#include <cmath>
#include <functional>
#include <limits>
#include <numeric>
#include <utility>

#include "base/interrupt.h"
#include "solver/contact_sets.h"

namespace mortier {
namespace {

signed char signOf(double value) {
  return static_cast<signed char>((value > 0 ? 1 : 0) - (value < 0 ? 1 : 0));
}

/// How many conditions differ.
int distance(const FrictionSets& a, const FrictionSets& b) {
  const auto differing = [](const auto& x, const auto& y) {
    return std::inner_product(x.begin(), x.end(), y.begin(), 0, std::plus<>(), std::not_equal_to<>());
  };
  return differing(a.closed, b.closed) + differing(a.slip, b.slip);
}

/// The first condition that differs goes over from one to the other.
void changeFirst(FrictionSets& sets, const FrictionSets& next) {
  const auto change = [](auto& from, const auto& to) {
    const auto [at, there] = std::mismatch(from.begin(), from.end(), to.begin());
    if (at == from.end()) return false;
    *at = *there;
    return true;
  };
  if (!change(sets.closed, next.closed)) change(sets.slip, next.slip);
}

}  // namespace

FrictionSystem::FrictionSystem(const ContactProblem& problem, const Vector& q, Springs springs,
                               FrictionWork& work)
    : problem_(problem),
      law_(problem.along.law),
      q_(q),
      springs_(std::move(springs)),
      work_(work),
      idle_(idleConditions(problem.W.diagonal())),
      compliance_(problem.W.diagonal()) {
  for (Eigen::Index i = 0; i < q.size(); ++i)
    if (idle(i)) compliance_[i] = 1;
  for (Eigen::Index row = normals(); components() > 1 && row < q.size(); row += 2)  // whatever its directions
    compliance_.segment<2>(row).setConstant(compliance_.segment<2>(row).mean());
}

FrictionSystem FrictionSystem::underBounds(const Vector& limit) const {
  FrictionSystem system = *this;
  system.law_ = {Vector::Zero(limit.size()), limit};
  return system;
}

bool FrictionSystem::sticks(const FrictionSets& sets, Eigen::Index node) const {
  const bool presses = sets.closed[problem_.along.node[node]] != 0 || law_.limit[node] > 0;
  return sets.slip[node] == 0 && presses && !idle(first(node));
}

void FrictionSystem::holdIdle(FrictionSets& sets) const {
  const Eigen::Index n = normals();
  for (Eigen::Index i = 0; i < n; ++i)
    if (idle(i)) sets.closed[i] = 0;
  if (components() > 1) return;
  for (Eigen::Index row = n; row < q_.size(); ++row) {
    if (!idle(row)) continue;
    const bool moves = std::abs(q_[row]) > roundingOfForces * q_.lpNorm<Eigen::Infinity>();
    sets.slip[row - n] = moves ? signOf(-q_[row]) : 0;
  }
}

FrictionSets FrictionSystem::allHeld() const {
  const size_t nodes = problem_.along.node.size();
  FrictionSets sets{std::vector<char>(normals(), 1), std::vector<signed char>(nodes, 0)};
  if (components() > 1) sets.directions.resize(nodes);
  holdIdle(sets);
  return sets;
}

HeldConditions FrictionSystem::heldOn(const FrictionSets& sets) const {
  HeldConditions held;
  const Eigen::Index n = normals();
  std::vector<Eigen::Index> place(n, -1);
  for (Eigen::Index i = 0; i < n; ++i) {
    if (sets.closed[i] == 0) continue;
    place[i] = static_cast<Eigen::Index>(held.rows.size());
    held.rows.push_back(i);
  }
  for (Eigen::Index k = 0; k < q_.size() - n; ++k) {
    const Eigen::Index leader = place[problem_.along.node[k]];
    const double part = sets.slip[k] * law_.coefficient[k];
    if (sticks(sets, k))
      held.rows.push_back(n + k);
    else if (leader >= 0 && part != 0)
      held.followers.push_back({n + k, leader, part});
  }
  return held;
}

HeldSystem::HeldSystem(const ContactProblem& problem, HeldConditions held, double softness, double stiffness,
                       bool transposed)
    : held_(std::move(held)) {
  const std::vector<Eigen::Index>& rows = held_.rows;
  const auto n = static_cast<Eigen::Index>(rows.size());
  const Eigen::Index motions = problem.G.cols();
  if (motions > 0) unit_ = problem.W.diagonal().maxCoeff() / problem.G.cwiseAbs().maxCoeff();
  Matrix A(n + motions, n + motions);
  A.topLeftCorner(n, n) = problem.W(rows, rows);
  A.topLeftCorner(n, n).diagonal().array() += softness;
  if (motions > 0) {
    A.topRightCorner(n, motions) = -unit_ * problem.G(rows, Eigen::all);
    A.bottomLeftCorner(motions, n) = unit_ * problem.G(rows, Eigen::all).transpose();
    A.bottomRightCorner(motions, motions) = unit_ * unit_ * stiffness * Matrix::Identity(motions, motions);
  }
  for (const auto& [row, leader, part] : held_.followers) {
    A.col(leader).head(n) += part * problem.W(rows, row);
    if (motions > 0) A.col(leader).tail(motions) += part * unit_ * problem.G.row(row).transpose();
  }
  if (transposed) {  // which has G with the signs exchanged
    A.transposeInPlace();
    unit_ = -unit_;
  }
  factor_.factorise(std::move(A), false);
}

void HeldSystem::solve(Vector& f, Vector& h) const {
  Matrix x(f.size() + h.size(), 1);
  x << f, unit_ * h;
  factor_.solve(x);
  f = x.col(0).head(f.size());
  h = unit_ * x.col(0).tail(h.size());
}

std::optional<FrictionSolution> FrictionSystem::solve(const HeldSystem& equations, const FrictionSets& sets,
                                                      double part, const TwoPartSums& start) const {
  const Eigen::Index n = normals();
  const auto& [held, followers] = equations.held();
  const Matrix G = -problem_.G;
  TwoPartVector x = TwoPartVector::zero(q_.size());
  TwoPartVector z{part * springs_.z0, Vector::Zero(G.cols())};
  for (Eigen::Index k = 0; k < q_.size() - n; ++k)
    if (!sticks(sets, k)) x.high[n + k] = part * sets.slip[k] * law_.limit[k];
  FrictionSolution result;
  result.sets = sets;
  result.index = equations.sign();
  const auto evaluate = [&] {
    TwoPartSums motion = start;
    motion.add(problem_.W, x);
    motion.add(G, z);
    result.motion = motion.value();
    result.force = x.value();
  };
  evaluate();
  // Corrections go on until they are nothing beside the forces: signs that rounding decides are not those of
  // one problem.
  constexpr double enough = 1e-10;  // each is less by the square of that
  constexpr double zero = 1e-26;
  double largest = start.value().cwiseQuotient(compliance_).lpNorm<Eigen::Infinity>();
  double last = std::numeric_limits<double>::infinity();
  Vector change = Vector::Zero(q_.size());
  while (true) {
    TwoPartSums unbalanced(part * (springs_.load + springs_.stiffness * springs_.z0));
    unbalanced.add(G.transpose(), x);
    unbalanced.add(-springs_.stiffness * Matrix::Identity(G.cols(), G.cols()), z);
    Vector forces = -result.motion(held);
    Vector motions = unbalanced.value();
    equations.solve(forces, motions);
    change(held) = forces;
    x += change;
    z += motions;
    for (const auto& [row, leader, mu] : followers) {
      const Eigen::Index across = held[leader];
      const DoubleDouble product = DoubleDouble::product(mu, x.high[across]);
      const DoubleDouble sum =
          DoubleDouble::sum(part * sets.slip[row - n] * law_.limit[row - n], product.high);
      x.high[row] = sum.high;
      x.low[row] = sum.low + product.low + mu * x.low[across];
    }
    evaluate();
    const double correction = change.lpNorm<Eigen::Infinity>();
    const double size = result.force.lpNorm<Eigen::Infinity>();
    largest = std::max(largest, size);
    if (!(correction > std::max(enough * size, zero * largest))) break;
    if (!(correction < last / 2)) return std::nullopt;
    last = std::isinf(last) ? std::max(correction, largest) : correction;
  }
  result.rigid = z.value();
  return result;
}

std::optional<FrictionSolution> FrictionSystem::solveOn(const FrictionSets& sets) const {
  const double negligible = problem_.G.cols() > 0 ? 1e-15 : 1e-12;  // as in ActiveFactor
  stopIfInterrupted();
  const HeldSystem equations(problem_, heldOn(sets), 0, springs_.stiffness);
  work_.solves += equations.size() > 0 ? 1 : 0;
  std::optional<FrictionSolution> trial;
  if (equations.leastPivot() > negligible) {
    work_.ambiguous = work_.ambiguous || equations.sign() < 0;
    trial = solve(equations, sets, 1, TwoPartSums(q_));
  }
  work_.singular = work_.singular || !trial;
  return trial && trial->force.allFinite() ? trial : std::nullopt;
}

double FrictionSystem::bound(const FrictionSolution& trial, Eigen::Index node) const {
  const double p = std::max(trial.force[problem_.along.node[node]], 0.0);
  return law_.coefficient[node] * p + law_.limit[node];
}

FrictionSets FrictionSystem::next(const FrictionSolution& trial) const {
  const Eigen::Index n = normals();
  const FrictionSets& sets = trial.sets;
  const Vector aim = trial.force - trial.motion.cwiseQuotient(compliance_);
  FrictionSets next = sets;
  for (Eigen::Index i = 0; i < n; ++i)
    next.closed[i] = !idle(i) && (sets.closed[i] != 0 ? trial.force[i] : aim[i]) > 0 ? 1 : 0;
  for (Eigen::Index k = 0; k < law_.limit.size(); ++k) {
    const Eigen::Index row = first(k);
    if (components() > 1) {
      nextInSpace(trial, aim, k, next);
      continue;
    }
    if (idle(row)) continue;
    const int i = problem_.along.node[k];
    // Of nodes that stick v is 0, of those that slip |t| is the bound, whatever rounding makes of them.
    if (next.closed[i] == 0 && !(law_.limit[k] > 0))
      next.slip[k] = 1;
    else if (sticks(sets, k))
      next.slip[k] = std::abs(trial.force[row]) <= bound(trial, k) ? 0 : signOf(trial.force[row]);
    else if (sets.closed[i] != 0 || law_.limit[k] > 0)
      next.slip[k] = trial.motion[row] * sets.slip[k] > 0 ? 0 : sets.slip[k];
    else
      next.slip[k] = std::abs(aim[row]) <= bound(trial, k) ? 0 : signOf(aim[row]);
  }
  return next;
}

Vector FrictionSystem::offLaw(const FrictionSolution& trial) const {
  const Eigen::Index n = normals();
  const Vector aim = trial.force - trial.motion.cwiseQuotient(compliance_);
  Vector asked = trial.force;
  for (Eigen::Index i = 0; i < n; ++i)
    if (!idle(i)) asked[i] = std::max(aim[i], 0.0);
  for (Eigen::Index k = 0; k < law_.limit.size(); ++k) {
    const Eigen::Index row = first(k);
    const double limit = bound(trial, k);
    if (components() > 1)
      asked.segment<2>(row) = withinBall(aim.segment<2>(row), limit);
    else if (!idle(row))
      asked[row] = std::clamp(aim[row], -limit, limit);
  }
  return trial.force - asked;
}

double FrictionSystem::residual(const FrictionSolution& trial) const {
  const double worst = offLaw(trial).lpNorm<Eigen::Infinity>();
  double scale = 0;
  for (Eigen::Index i = 0; i < q_.size(); ++i)
    if (!idle(i)) scale = std::max({scale, std::abs(trial.force[i]), std::abs(q_[i] / compliance_[i])});
  return worst > 0 ? worst / scale : 0;
}

FrictionSolution FrictionSystem::clipped(FrictionSolution trial) const {
  const Eigen::Index n = normals();
  trial.solved = true;
  trial.residual = residual(trial);
  for (Eigen::Index i = 0; i < n; ++i) {
    if (trial.sets.closed[i] != 0) trial.motion[i] = 0;
    trial.force[i] = trial.sets.closed[i] != 0 ? std::max(trial.force[i], 0.0) : 0;
  }
  for (Eigen::Index k = 0; k < law_.limit.size(); ++k) {
    double& t = trial.force[first(k)];
    const double limit = bound(trial, k);
    if (components() > 1) {
      clipInSpace(trial, k);
      continue;
    }
    if (sticks(trial.sets, k)) trial.motion[first(k)] = 0;
    t = sticks(trial.sets, k) ? std::clamp(t, -limit, limit) : trial.sets.slip[k] * limit;
  }
  return trial;
}

std::optional<FrictionSolution> FrictionSystem::asSolution(FrictionSolution trial) const {
  if (!(residual(trial) <= roundingOfForces)) return std::nullopt;
  return clipped(std::move(trial));
}

std::optional<FrictionSolution> FrictionSystem::newton(FrictionSets sets) const {
  if (components() > 1) return newtonInSpace(std::move(sets));
  constexpr int patience = 20;
  std::vector<FrictionSets> before;
  int fewest = std::numeric_limits<int>::max();
  double least = std::numeric_limits<double>::infinity();
  holdIdle(sets);
  for (int left = patience; left > 0 && std::find(before.begin(), before.end(), sets) == before.end();
       --left) {
    const std::optional<FrictionSolution> trial = solveOn(sets);
    if (!trial) return std::nullopt;
    FrictionSets following = next(*trial);
    const double off = residual(*trial);
    if (following == sets || off <= roundingOfForces) return clipped(*trial);
    const int wrong = distance(sets, following);
    if (wrong < fewest || off < least) left = patience;
    fewest = std::min(fewest, wrong);
    least = std::min(least, off);
    before.push_back(std::exchange(sets, std::move(following)));
  }
  return std::nullopt;
}

std::optional<FrictionSolution> FrictionSystem::changeSingly(FrictionSets sets, int most) const {
  constexpr int patience = 10;
  int best = std::numeric_limits<int>::max();
  int left = patience;
  holdIdle(sets);
  for (int solve = 0; solve < most; ++solve) {
    const std::optional<FrictionSolution> trial = solveOn(sets);
    if (!trial) return std::nullopt;
    FrictionSets following = next(*trial);
    const int wrong = distance(sets, following);
    if (wrong == 0 || residual(*trial) <= roundingOfForces) return clipped(*trial);
    if (wrong < best) {
      best = wrong;
      left = patience;
    }
    if (left-- > 0)
      sets = std::move(following);
    else
      changeFirst(sets, following);
  }
  return std::nullopt;
}

}  // namespace mortier
