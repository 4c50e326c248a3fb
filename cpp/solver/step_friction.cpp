// Friction in the contact problem of a linearised step.
#include <cmath>
#include <utility>

#include "solver/friction_motions.h"
#include "solver/friction_solutions.h"
#include "solver/step_system.h"

namespace mortier {
namespace {

/// Whether a node that slips alone has det A = W_nn -+ mu W_nt < 0: pushed along, it would be jammed.
bool jamsAlone(const Matrix& W, const FrictionRows& rows) {
  const Eigen::Index n = W.rows() - static_cast<Eigen::Index>(rows.node.size());
  for (size_t k = 0; k < rows.node.size(); ++k) {
    const int i = rows.node[k];
    const auto row = static_cast<Eigen::Index>(k);
    if (W(i, i) < rows.law.coefficient[row] * std::abs(W(i, n + row))) return true;
  }
  return false;
}

}  // namespace

void StepSystem::findFriction() {
  std::vector<Vector> limits;
  for (size_t k = 0; k < model_.interfaces.size(); ++k) {
    const ContactInterface& interface = model_.interfaces[k];
    if (!interface.hasFriction()) continue;
    for (int i = 0; i < interface.rows(); ++i) friction_.node.push_back(firstRow_[k] + i);
    limits.push_back(interface.frictionBound(Vector::Zero(interface.rows())));
  }
  FrictionLaw& law = friction_.law;
  law = {Vector(friction_.node.size()), Vector(friction_.node.size())};
  Eigen::Index row = 0;
  size_t part = 0;
  for (const ContactInterface& interface : model_.interfaces) {
    if (!interface.hasFriction()) continue;
    law.coefficient.segment(row, interface.rows()).setConstant(interface.friction().coefficient);
    law.limit.segment(row, interface.rows()) = limits[part++];
    row += interface.rows();
  }
}

ListedSolution StepSystem::listed(const FrictionSolution& solution) const {
  const Eigen::Index n = rows();
  std::string sets(solution.sets.closed.size(), 'o');
  for (size_t i = 0; i < sets.size(); ++i)
    if (solution.sets.closed[i] != 0) sets[i] = 'c';
  for (size_t k = 0; k < friction_.node.size(); ++k) {
    const bool bears =
        sets[friction_.node[k]] == 'c' || friction_.law.limit[static_cast<Eigen::Index>(k)] > 0;
    const int slip = solution.sets.slip[k];
    if (bears) sets[friction_.node[k]] = slip == 0 ? 's' : slip > 0 ? '+' : '-';
  }
  return {solution.index, solution.residual, solution.force.head(n).sum(),
          solution.force.tail(solution.force.size() - n).sum(), std::move(sets)};
}

StepSolutions StepSystem::takeSolutions() {
  return std::exchange(solutions_, {});
}

ContactSolution StepSystem::Condensed::solveFriction() const {
  const Matrix& W = system_->contact_.W;
  const ContactProblem& contact = system_->contact_;
  const bool asked = system_->options_.listSolutions;
  LooseFriction loose;
  const Vector q = slack - W * p0;
  if (contact.G.cols() > 0) {
    loose = solveLooseFriction(W, system_->friction_, contact.G, balance + contact.G.transpose() * p0,
                               contact.force, contact.proximal, q, {active, slipping}, asked);
  } else {
    loose.solution = mortier::solveFriction({W, system_->friction_}, q, {active, slipping});
    loose.balanced = true;
    if (asked && loose.solution.solved)
      loose.all = solutionsOnPath({W, system_->friction_}, q, loose.solution);
  }
  StepSolutions& solutions = system_->solutions_;
  solutions.ambiguous = solutions.ambiguous || loose.solution.ambiguous || loose.all.size() > 1 ||
                        (contact.G.cols() == 0 && jamsAlone(W, system_->friction_));
  solutions.listed.clear();
  for (const FrictionSolution& each : loose.all) solutions.listed.push_back(system_->listed(each));
  const FrictionSolution& found = loose.solution;
  ContactSolution solution;
  solution.outcome = found.solved     ? ContactSolution::Outcome::solved
                     : found.singular ? ContactSolution::Outcome::dependent
                                      : ContactSolution::Outcome::cycled;
  solution.rigid = loose.rigid;
  solution.pivots = found.solves + found.events;
  if (!found.solved) return solution;
  if (SpecialConditions& special = system_->special_; found.singular && special.dependent == 0)
    special.dependent = dependentConditions(W);
  if (!loose.balanced) solution.outcome = ContactSolution::Outcome::unbalanced;
  solution.change = found.force - p0;
  solution.active = found.sets.closed;
  solution.slipping = found.sets.slip;
  return solution;
}

}  // namespace mortier
