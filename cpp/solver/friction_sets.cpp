#include "solver/friction_sets.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>

#include "base/interrupt.h"
#include "base/two_part_sums.h"

namespace mortier {
namespace {

/// What is left of a solution on sets that are right, and of those that differ by ties.
constexpr double rounding = 1e-13;

signed char signOf(double value) {
  return static_cast<signed char>((value > 0 ? 1 : 0) - (value < 0 ? 1 : 0));
}

/// How many conditions differ.
int distance(const FrictionSets& a, const FrictionSets& b) {
  int count = 0;
  for (size_t i = 0; i < a.closed.size(); ++i) count += a.closed[i] != b.closed[i] ? 1 : 0;
  for (size_t k = 0; k < a.slip.size(); ++k) count += a.slip[k] != b.slip[k] ? 1 : 0;
  return count;
}

/// The first condition that differs goes over from one to the other.
void changeFirst(FrictionSets& sets, const FrictionSets& next) {
  for (size_t i = 0; i < sets.closed.size(); ++i)
    if (sets.closed[i] != next.closed[i]) {
      sets.closed[i] = next.closed[i];
      return;
    }
  for (size_t k = 0; k < sets.slip.size(); ++k)
    if (sets.slip[k] != next.slip[k]) {
      sets.slip[k] = next.slip[k];
      return;
    }
}

}  // namespace

FrictionSystem::FrictionSystem(const FrictionProblem& problem, const Vector& q)
    : problem_(problem), q_(q), compliance_(problem.W.diagonal()), idle_(q.size(), 0) {
  constexpr double negligible = 1e-24;  // W is quadratic in the rows of C
  const double largest = q.size() > 0 ? compliance_.cwiseAbs().maxCoeff() : 0;
  for (Eigen::Index i = 0; i < q.size(); ++i)
    if (std::abs(compliance_[i]) <= negligible * largest) {
      idle_[i] = 1;
      compliance_[i] = 1;
    }
}

bool FrictionSystem::sticks(const FrictionLaw& law, const FrictionSets& sets, size_t tangential) const {
  const auto k = static_cast<Eigen::Index>(tangential);
  const bool bound = sets.closed[problem_.rows.node[tangential]] != 0 || law.limit[k] > 0;
  return sets.slip[tangential] == 0 && bound && !idle(normals() + k);
}

void FrictionSystem::holdIdle(FrictionSets& sets) const {
  const Eigen::Index n = normals();
  for (Eigen::Index i = 0; i < n; ++i)
    if (idle(i)) sets.closed[i] = 0;
  for (size_t k = 0; k < sets.slip.size(); ++k) {
    const auto row = n + static_cast<Eigen::Index>(k);
    if (!idle(row)) continue;
    const bool moves = std::abs(q_[row]) > rounding * q_.lpNorm<Eigen::Infinity>();
    sets.slip[k] = moves ? signOf(-q_[row]) : 0;
  }
}

FrictionSets FrictionSystem::allHeld() const {
  FrictionSets sets{std::vector<char>(normals(), 1), std::vector<signed char>(problem_.rows.node.size(), 0)};
  holdIdle(sets);
  return sets;
}

Vector FrictionSystem::motionOf(TwoPartSums start, const TwoPartVector& x, const TwoPartVector& z) const {
  start.add(problem_.W, x);
  if (const FreeMotions* free = problem_.motions) start.add(-free->G, z);
  return start.value();
}

Vector FrictionSystem::unbalanced(double part, const TwoPartVector& x, const TwoPartVector& z) const {
  const FreeMotions& free = *problem_.motions;
  TwoPartSums sums(part * (free.load + free.spring * free.z0));
  sums.add(-free.G.transpose(), x);
  sums.add(-free.spring * Matrix::Identity(free.G.cols(), free.G.cols()), z);
  return sums.value();
}

bool FrictionSystem::solveOn(const FrictionLaw& law, const FrictionSets& sets, Trial& trial) {
  const FreeMotions* free = problem_.motions;
  const double negligible = free != nullptr ? 1e-15 : 1e-12;  // as in ActiveFactor
  stopIfInterrupted();
  const Eigen::Index n = normals();
  std::vector<Eigen::Index> rows;
  for (Eigen::Index i = 0; i < n; ++i)
    if (sets.closed[i] != 0) rows.push_back(i);
  const auto slips = [&](size_t k) { return !sticks(law, sets, k); };
  TwoPartVector x = TwoPartVector::zero(q_.size());
  TwoPartVector z{free != nullptr ? free->z0 : Vector(), Vector::Zero(free != nullptr ? free->G.cols() : 0)};
  for (size_t k = 0; k < sets.slip.size(); ++k) {
    const auto row = n + static_cast<Eigen::Index>(k);
    if (sticks(law, sets, k)) rows.push_back(row);
    if (slips(k)) x.high[row] = sets.slip[k] * law.limit[row - n];
  }
  // t = +-(mu p + c) of nodes that slip follows p. The motions come last, in a unit in which G is as W.
  const auto held = static_cast<Eigen::Index>(rows.size());
  const Eigen::Index motions = free != nullptr ? free->G.cols() : 0;
  const double unit = motions > 0 ? compliance_.maxCoeff() / free->G.cwiseAbs().maxCoeff() : 1;
  Matrix A(held + motions, held + motions);
  A.topLeftCorner(held, held) = problem_.W(rows, rows);
  if (motions > 0) {
    A.topRightCorner(held, motions) = -unit * free->G(rows, Eigen::all);
    A.bottomLeftCorner(motions, held) = unit * free->G(rows, Eigen::all).transpose();
    A.bottomRightCorner(motions, motions) = unit * unit * free->spring * Matrix::Identity(motions, motions);
  }
  std::vector<Eigen::Index> columnOf(n, -1);
  for (size_t j = 0; j < rows.size() && rows[j] < n; ++j) columnOf[rows[j]] = static_cast<Eigen::Index>(j);
  const auto forEachFollower = [&](auto visit) {
    for (size_t k = 0; k < sets.slip.size(); ++k) {
      const auto row = n + static_cast<Eigen::Index>(k);
      const Eigen::Index column = columnOf[problem_.rows.node[k]];
      if (column >= 0 && slips(k)) visit(row, column, sets.slip[k] * law.coefficient[row - n]);
    }
  };
  forEachFollower([&](Eigen::Index row, Eigen::Index column, double part) {
    if (part == 0) return;
    A.col(column).head(held) += part * problem_.W(rows, row);
    if (motions > 0) A.col(column).tail(motions) += part * unit * free->G.row(row).transpose();
  });
  trial.index = 1;
  trial.force = x.value();
  trial.motion = motionOf(TwoPartSums(q_), x, z);
  if (A.rows() == 0) return true;
  ++solves_;
  DenseFactor factor;
  if (!factor.factorise(std::move(A), false) || !(factor.leastPivot() > negligible)) {
    singular_ = true;
    return false;
  }
  trial.index = factor.sign();
  ambiguous_ = ambiguous_ || trial.index < 0;
  // Corrections go on until they are nothing beside the forces: signs that rounding decides are not those of
  // one problem.
  Corrections corrections(q_.cwiseQuotient(compliance_).lpNorm<Eigen::Infinity>());
  while (true) {
    Matrix change(held + motions, 1);
    change.topRows(held) = -trial.motion(rows);
    if (motions > 0) change.bottomRows(motions) = unit * unbalanced(1, x, z);
    factor.solve(change);
    Vector all = Vector::Zero(q_.size());
    all(rows) = change.col(0).head(held);
    x += all;
    z += unit * change.col(0).tail(motions);
    forEachFollower([&](Eigen::Index row, Eigen::Index column, double part) {
      const double limit = sets.slip[row - n] * law.limit[row - n];
      const DoubleDouble bound = DoubleDouble::product(part, x.high[rows[column]]);
      const DoubleDouble sum = DoubleDouble::sum(limit, bound.high);
      x.high[row] = sum.high;
      x.low[row] = sum.low + bound.low + part * x.low[rows[column]];
    });
    trial.force = x.value();
    trial.motion = motionOf(TwoPartSums(q_), x, z);
    if (!corrections.goOn(all.lpNorm<Eigen::Infinity>(), trial.force.lpNorm<Eigen::Infinity>())) break;
  }
  if (corrections.failed()) {
    singular_ = true;
    return false;
  }
  trial.rigid = z.value();
  return trial.force.allFinite();
}

FrictionSets FrictionSystem::next(const FrictionLaw& law, const FrictionSets& sets,
                                  const Trial& trial) const {
  const Eigen::Index n = normals();
  const Vector aim = trial.force - trial.motion.cwiseQuotient(compliance_);
  FrictionSets next = sets;
  for (Eigen::Index i = 0; i < n; ++i)
    next.closed[i] = !idle(i) && (sets.closed[i] != 0 ? trial.force[i] : aim[i]) > 0 ? 1 : 0;
  for (size_t k = 0; k < next.slip.size(); ++k) {
    const auto row = n + static_cast<Eigen::Index>(k);
    if (idle(row)) continue;
    const int i = problem_.rows.node[k];
    if (next.closed[i] == 0 && !(law.limit[row - n] > 0)) {
      next.slip[k] = 1;
      continue;
    }
    const double bound = law.coefficient[row - n] * std::max(trial.force[i], 0.0) + law.limit[row - n];
    // Of nodes that stick v is 0, of those that slip |t| is the bound, whatever rounding makes of them.
    if (sticks(law, sets, k))
      next.slip[k] = std::abs(trial.force[row]) <= bound ? 0 : signOf(trial.force[row]);
    else if (sets.closed[i] != 0 || law.limit[row - n] > 0)
      next.slip[k] = trial.motion[row] * sets.slip[k] > 0 ? 0 : sets.slip[k];
    else
      next.slip[k] = std::abs(aim[row]) <= bound ? 0 : signOf(aim[row]);
  }
  return next;
}

double FrictionSystem::residual(const FrictionLaw& law, const Trial& trial) const {
  const Eigen::Index n = normals();
  const Vector aim = trial.force - trial.motion.cwiseQuotient(compliance_);
  double worst = 0;
  double scale = 0;
  for (Eigen::Index i = 0; i < q_.size(); ++i) {
    if (idle(i)) continue;
    scale = std::max({scale, std::abs(trial.force[i]), std::abs(q_[i] / compliance_[i])});
    double asked = std::max(aim[i], 0.0);
    if (i >= n) {
      const double p = std::max(trial.force[problem_.rows.node[i - n]], 0.0);
      const double bound = law.coefficient[i - n] * p + law.limit[i - n];
      asked = std::clamp(aim[i], -bound, bound);
    }
    worst = std::max(worst, std::abs(trial.force[i] - asked));
  }
  return worst > 0 ? worst / scale : 0;
}

FrictionSolution FrictionSystem::solution(const FrictionLaw& law, const FrictionSets& sets,
                                          const Trial& trial) const {
  const Eigen::Index n = normals();
  FrictionSolution result{true, trial.force, trial.motion, sets,       residual(law, trial), trial.index,
                          0,    0,           false,        trial.rigid};
  for (Eigen::Index i = 0; i < n; ++i) {
    if (sets.closed[i] != 0) result.motion[i] = 0;
    result.force[i] = sets.closed[i] != 0 ? std::max(trial.force[i], 0.0) : 0;
  }
  for (size_t k = 0; k < sets.slip.size(); ++k) {
    const auto row = n + static_cast<Eigen::Index>(k);
    double& t = result.force[row];
    const double bound = law.coefficient[row - n] * result.force[problem_.rows.node[k]] + law.limit[row - n];
    if (sticks(law, sets, k)) {
      result.motion[row] = 0;
      t = std::clamp(t, -bound, bound);
    } else {
      t = sets.slip[k] * bound;
    }
  }
  return result;
}

std::optional<FrictionSolution> FrictionSystem::newton(const FrictionLaw& law, FrictionSets sets) {
  constexpr int patience = 20;
  std::vector<FrictionSets> before;
  int fewest = std::numeric_limits<int>::max();
  double least = std::numeric_limits<double>::infinity();
  holdIdle(sets);
  for (int left = patience; left > 0 && std::find(before.begin(), before.end(), sets) == before.end();
       --left) {
    Trial trial;
    if (!solveOn(law, sets, trial)) return std::nullopt;
    FrictionSets following = next(law, sets, trial);
    if (following == sets || residual(law, trial) <= rounding) return solution(law, sets, trial);
    const int wrong = distance(sets, following);
    const double off = residual(law, trial);
    if (wrong < fewest || off < least) left = patience;
    fewest = std::min(fewest, wrong);
    least = std::min(least, off);
    before.push_back(std::exchange(sets, std::move(following)));
  }
  return std::nullopt;
}

std::optional<FrictionSolution> FrictionSystem::bounded(const Vector& limit, FrictionSets sets,
                                                        Eigen::Index most) {
  constexpr int patience = 10;
  const FrictionLaw law{Vector::Zero(limit.size()), limit};
  holdIdle(sets);
  int best = std::numeric_limits<int>::max();
  int left = patience;
  for (Eigen::Index solve = 0; solve < most; ++solve) {
    Trial trial;
    if (!solveOn(law, sets, trial)) return std::nullopt;
    FrictionSets following = next(law, sets, trial);
    const int wrong = distance(sets, following);
    if (wrong == 0 || residual(law, trial) <= rounding) return solution(law, sets, trial);
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
