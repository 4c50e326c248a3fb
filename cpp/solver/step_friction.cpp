// Friction in the contact problem of a linearised step.
#include <cmath>
#include <utility>

#include "solver/step_system.h"

namespace mortier {
namespace {

/// Whether a node that slips alone has det A = W_nn -+ mu W_nt < 0: pushed along, it would be jammed.
bool jamsAlone(const ContactProblem& problem) {
  const auto& [node, law] = problem.along;
  for (size_t k = 0; k < node.size(); ++k) {
    const int i = node[k];
    const auto row = static_cast<Eigen::Index>(k);
    const double coupling = std::abs(problem.W(i, problem.normals() + row));
    if (problem.W(i, i) < law.coefficient[row] * coupling) return true;
  }
  return false;
}

}  // namespace

void StepSystem::findFriction() {
  auto& [node, law] = contact_.along;
  std::vector<Vector> coefficients;
  std::vector<Vector> limits;
  for (size_t k = 0; k < model_.interfaces.size(); ++k) {
    const ContactInterface& interface = model_.interfaces[k];
    if (!interface.hasFriction()) continue;
    for (int i = 0; i < interface.rows(); ++i) node.push_back(firstRow_[k] + i);
    coefficients.push_back(Vector::Constant(interface.rows(), interface.friction().coefficient));
    limits.push_back(interface.frictionBound(Vector::Zero(interface.rows())));
  }
  law = {joined(coefficients), joined(limits)};
}

ListedSolution StepSystem::listed(const FrictionSolution& solution) const {
  const Eigen::Index n = rows();
  std::string sets(solution.sets.closed.size(), 'o');
  for (size_t i = 0; i < sets.size(); ++i)
    if (solution.sets.closed[i] != 0) sets[i] = 'c';
  const auto& [node, law] = contact_.along;
  for (size_t k = 0; k < node.size(); ++k) {
    const bool bears = sets[node[k]] == 'c' || law.limit[static_cast<Eigen::Index>(k)] > 0;
    const signed char slip = solution.sets.slip[k];
    if (bears) sets[node[k]] = slip == 0 ? 's' : slip > 0 ? '+' : '-';
  }
  return {solution.index, solution.residual, solution.force.head(n).sum(),
          solution.force.tail(solution.force.size() - n).sum(), std::move(sets)};
}

StepSolutions StepSystem::takeSolutions() {
  return std::exchange(solutions_, {});
}

ContactSolution StepSystem::Condensed::solveFriction() const {
  const ContactProblem& problem = system_->contact_;
  std::vector<FrictionSolution> all;
  const FrictionSolution found =
      mortier::solveFriction(problem, slack - problem.W * p0, sets, balance + problem.G.transpose() * p0,
                             system_->options_.listSolutions ? &all : nullptr);
  StepSolutions& solutions = system_->solutions_;
  solutions.ambiguous = solutions.ambiguous || found.ambiguous || all.size() > 1 ||
                        (problem.G.cols() == 0 && jamsAlone(problem));
  solutions.listed.clear();
  for (const FrictionSolution& each : all) solutions.listed.push_back(system_->listed(each));
  ContactSolution solution;
  solution.rigid = found.rigid;
  solution.pivots = found.solves + found.events;
  if (!found.solved) {
    if (found.singular) solution.outcome = ContactSolution::Outcome::dependent;
    return solution;
  }
  solution.outcome = found.balanced ? ContactSolution::Outcome::solved : ContactSolution::Outcome::unbalanced;
  if (SpecialConditions& special = system_->special_; found.singular && special.dependent == 0)
    special.dependent = dependentConditions(problem.W);
  solution.change = found.force - p0;
  solution.active = found.sets.closed;
  solution.slipping = found.sets.slip;
  return solution;
}

}  // namespace mortier
