// The linear contact problem on given sets.
#pragma once

#include <optional>
#include <utility>

#include "solver/friction_sets.h"

namespace mortier {

/// s = 0 on closed conditions, dp = 0 off them, the
/// balance G' dp = `balance`, as stresses do no work on rigid motions.
class ClosedContact {
 public:
  /// \param adjoint  the transposed equations: t of slipping nodes is 0, and s + (+-mu) v = 0 there
  ClosedContact(const ContactProblem& problem, const FrictionSets& sets, bool adjoint)
      : problem_(problem), adjoint_(adjoint) {
    constexpr double regularising = 1e-12;  // where conditions or motions are redundant
    FrictionWork work;
    const Vector none = Vector::Zero(problem.W.rows());
    if (problem.along.components > 1) aligned_.emplace(problem, problem.along.law, sets);
    const ContactProblem& plane = aligned_ ? aligned_->problem() : problem;
    HeldConditions held = FrictionSystem(plane, none, {}, work).heldOn(aligned_ ? aligned_->sets() : sets);
    if (held.rows.empty()) return;
    const double compliance = plane.W.diagonal()(held.rows).cwiseAbs().maxCoeff();
    equations_.emplace(plane, std::move(held), regularising * compliance, regularising / compliance, adjoint);
  }

  [[nodiscard]] ContactSolution solve(const Vector& given, const Vector& balance) const {
    const Vector slack = aligned_ ? aligned_->aligned(given) : given;
    ContactSolution solution;
    solution.change = Vector::Zero(slack.size());
    solution.rigid = Vector::Zero(problem_.G.cols());
    if (!equations_) return solution;
    const auto& [held, followers] = equations_->held();
    Vector forces = -slack(held);
    for (const auto& [row, leader, part] : followers)
      if (adjoint_) forces[leader] -= part * slack[row];
    solution.rigid = balance;
    equations_->solve(forces, solution.rigid);
    solution.change(held) = forces;
    for (const auto& [row, leader, part] : followers)
      if (!adjoint_) solution.change[row] = part * forces[leader];
    if (aligned_) solution.change = aligned_->back(std::move(solution.change));
    return solution;
  }

 private:
  const ContactProblem& problem_;
  bool adjoint_;
  std::optional<AlignedProblem> aligned_;
  std::optional<HeldSystem> equations_;
};

}  // namespace mortier
