// Friction in space: sets of given directions of slip, and the next directions.

#include <Eigen/Eigenvalues>
#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>

#include "base/interrupt.h"
#include "solver/friction_sets.h"

namespace mortier {

AlignedProblem::AlignedProblem(const ContactProblem& problem, const FrictionLaw& law,
                               const FrictionSets& sets)
    : turning_(Vector::Zero(problem.W.rows())), problem_(problem) {
  const Eigen::Index n = problem.normals();
  FrictionRows& along = problem_.along;
  along = {};
  const auto nodes = static_cast<Eigen::Index>(sets.slip.size());
  along.law = {Vector(2 * nodes), Vector(2 * nodes)};
  sets_.closed = sets.closed;
  for (Eigen::Index k = 0; k < nodes; ++k) {
    const auto& [direction, turning] = sets.directions[k];
    const bool slips = sets.slip[k] != 0 && !direction.isZero(0);
    directions_.emplace_back(slips ? direction : Point(1, 0));
    if (slips) turning_[n + 2 * k + 1] = turning;
    // A node that slips in no direction has no force.
    sets_.slip.push_back(sets.slip[k]);
    sets_.slip.push_back(slips ? 0 : sets.slip[k]);
    for (Eigen::Index row = 2 * k; row < 2 * k + 2; ++row) {
      along.node.push_back(problem.along.node[k]);
      along.law.coefficient[row] = sets.slip[k] != 0 && !slips ? 0 : law.coefficient[k];
      along.law.limit[row] = sets.slip[k] != 0 && !slips ? 0 : law.limit[k];
    }
  }
  Matrix& W = problem_.W;
  Vector turned(W.rows());
  for (Eigen::Index k = 0; k < nodes; ++k) {
    const Point& d = directions_[k];
    if (d.y() == 0 && d.x() == 1) continue;
    auto first = W.col(n + 2 * k);
    auto second = W.col(n + 2 * k + 1);
    turned = d.x() * first + d.y() * second;
    second = d.x() * second - d.y() * first;
    first = turned;
  }
  for (Eigen::Index column = 0; column < W.cols(); ++column) turn(W.col(column), 1);
  W.diagonal() += turning_;
  for (Eigen::Index z = 0; z < problem_.G.cols(); ++z) turn(problem_.G.col(z), 1);
}

void AlignedProblem::turn(Eigen::Ref<Vector> x, int way) const {
  const Eigen::Index n = problem_.normals();
  for (size_t k = 0; k < directions_.size(); ++k) {
    const Point& d = directions_[k];
    auto pair = x.segment<2>(n + 2 * static_cast<Eigen::Index>(k));
    pair = Point(d.x() * pair.x() + way * d.y() * pair.y(), d.x() * pair.y() - way * d.y() * pair.x());
  }
}

std::optional<FrictionSolution> FrictionSystem::solveInSpace(const FrictionSets& sets) const {
  stopIfInterrupted();
  const AlignedProblem aligned(problem_, law_, sets);
  const Vector q = aligned.aligned(q_);
  std::optional<FrictionSolution> trial =
      FrictionSystem(aligned.problem(), q, springs_, work_).solveOn(aligned.sets());
  if (!trial) return trial;
  trial->motion = aligned.back(trial->motion + aligned.turning(trial->force));
  trial->force = aligned.back(std::move(trial->force));
  trial->sets = sets;
  return trial;
}

/// Where the law is further from being fulfilled, forces stay nearer to those before.
std::optional<FrictionSolution> FrictionSystem::newtonInSpace(FrictionSets sets) const {
  constexpr int most = 60;
  constexpr int patience = 3;    // steps of no use
  constexpr double less = 1e-4;  // of the part of the step
  constexpr double shortest = 1e-3;
  const auto sizeOff = [&](const FrictionSolution& trial) {
    return offLaw(trial).cwiseProduct(compliance_.cwiseSqrt()).norm();
  };
  FrictionSolution here;
  double before = std::numeric_limits<double>::infinity();
  holdIdle(sets);
  for (int solve = 0, vain = 0; solve < most && vain < patience; ++solve) {
    const std::optional<FrictionSolution> trial = solveInSpace(sets);
    if (!trial) return std::nullopt;
    if (const double off = residual(*trial); off <= roundingOfForces) {
      // Beside wide gaps that may be much of the forces, where directions still turn.
      const double ofForces = offLaw(*trial).lpNorm<Eigen::Infinity>();
      if (!(ofForces > roundingOfForces * trial->force.lpNorm<Eigen::Infinity>())) return clipped(*trial);
      const std::optional<FrictionSolution> again = solveInSpace(next(*trial));
      return clipped(again && residual(*again) < off ? *again : *trial);
    }
    FrictionSolution ahead = *trial;
    double size = sizeOff(ahead);
    if (!std::isfinite(size)) return std::nullopt;
    for (double part = 1; !(size <= (1 - less * part) * before) && part > shortest; size = sizeOff(ahead)) {
      part /= 2;
      ahead.force = here.force + part * (trial->force - here.force);
      ahead.motion = here.motion + part * (trial->motion - here.motion);
      // The next sets follow from forces and motions together, as of nodes that neither stick nor press.
      ahead.sets.closed.assign(sets.closed.size(), 0);
      ahead.sets.slip.assign(sets.slip.size(), 1);
    }
    vain = size < before ? 0 : vain + 1;
    before = size;
    sets = next(ahead);
    here = std::move(ahead);
  }
  return std::nullopt;
}

void FrictionSystem::nextInSpace(const FrictionSolution& trial, const Vector& aim, Eigen::Index node,
                                 FrictionSets& next) const {
  const Eigen::Index row = first(node);
  const Point force = sticks(trial.sets, node) ? trial.force.segment<2>(row) : aim.segment<2>(row);
  const double limit = bound(trial, node);
  const double size = force.norm();
  const bool presses = next.closed[problem_.along.node[node]] != 0 || law_.limit[node] > 0;
  next.slip[node] = presses && size <= limit ? 0 : 1;
  next.directions[node] = {};
  // t - v/W = (b + |v|/W) d
  if (next.slip[node] != 0 && limit > 0)
    next.directions[node] = {force / size, compliance_[row] * std::max(size - limit, 0.0) / limit};
}

void FrictionSystem::clipInSpace(FrictionSolution& trial, Eigen::Index node) const {
  auto t = trial.force.segment<2>(first(node));
  auto v = trial.motion.segment<2>(first(node));
  const double limit = bound(trial, node);
  SlipDirection& direction = trial.sets.directions[node];
  direction = {};
  if (sticks(trial.sets, node)) {
    v.setZero();
    t = withinBall(t, limit);
  } else if (const double size = t.norm(); size > 0 && limit > 0) {
    direction = {t / size, v.norm() / limit};
    t = limit * direction.along;
  } else {
    t.setZero();
  }
}

ContactProblem withoutIdleSlips(const ContactProblem& problem) {
  constexpr double idle = 1e-9;   // of the other compliance of a node
  constexpr double least = 1e-6;  // the force of a slip that supports make is what slips, not what sticks
  ContactProblem regular = problem;
  const double usual = problem.W.diagonal().maxCoeff();
  for (size_t k = 0; k < problem.along.node.size(); ++k) {
    const Eigen::Index row = problem.normals() + 2 * static_cast<Eigen::Index>(k);
    auto block = regular.W.block<2, 2>(row, row);
    const Eigen::SelfAdjointEigenSolver<Eigen::Matrix2d> eigen(Eigen::Matrix2d(block + block.transpose()) /
                                                               2);
    const double across = problem.W(problem.along.node[k], problem.along.node[k]);
    const double largest = std::max({eigen.eigenvalues()[1], across, idle * usual});
    for (int i = 0; i < 2; ++i) {
      if (eigen.eigenvalues()[i] > idle * largest) continue;
      const Point direction = eigen.eigenvectors().col(i);
      block += (least * largest - eigen.eigenvalues()[i]) * direction * direction.transpose();
    }
  }
  return regular;
}

}  // namespace mortier
