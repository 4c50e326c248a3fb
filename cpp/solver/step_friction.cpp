// Friction in the contact problem of a linearised step.

#include <algorithm>
#include <cmath>
#include <utility>

#include "solver/step_system.h"

namespace mortier {
namespace {

/// Whether a node that slips alone has det A = W_nn + mu W_nt d < 0 for a direction d: pushed along, it would
/// be jammed.
bool jamsAlone(const ContactProblem& problem) {
  const auto& [node, law, components] = problem.along;
  for (Eigen::Index k = 0; k < law.limit.size(); ++k) {
    const int i = node[k];
    const double coupling = problem.W.row(i).segment(problem.normals() + components * k, components).norm();
    if (problem.W(i, i) < law.coefficient[k] * coupling) return true;
  }
  return false;
}

}  // namespace

void StepSystem::findFriction() {
  auto& [node, law, components] = contact_.along;
  std::vector<Vector> coefficients;
  std::vector<Vector> limits;
  for (size_t k = 0; k < model_.interfaces.size(); ++k) {
    const ContactInterface& interface = model_.interfaces[k];
    if (!interface.hasFriction()) continue;
    components = interface.slipComponents();
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
  const auto& [node, law, components] = contact_.along;
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
  solution.directions = found.sets.directions;
  return solution;
}

bool StepSystem::Factorised::solve(const Step& step, Iterate& iterate, StepOutcome& outcome) const {
  Condensed condensed = condense(step, iterate);
  const ContactSolution contact = condensed.solveContact();
  return std::move(condensed).expand(contact, iterate, outcome);
}

ContactSolution StepSystem::Condensed::solveContact() const {
  if (system_->hasFriction()) return solveFriction();
  const ContactProblem& problem = system_->contact_;
  SpecialConditions& special = system_->special_;
  Vector motion;
  ContactSolution solution = system_->sparse()
                                 ? solveSparse(*system_->sparse_, problem, system_->gathered(force), slack,
                                               p0, balance, sets.closed, motion)
                                 : mortier::solveContact(problem, slack, p0, balance, sets.closed);
  if (system_->sparse() && solution.outcome == ContactSolution::Outcome::solved)
    solution.motion = system_->spread(motion, solution.rigid);
  if (!anyFollows(system_->model_))  // where rows follow, those that face nothing are idle too
    special.idle = std::max(special.idle, solution.idle);
  if (solution.dependent && special.dependent == 0) special.dependent = dependentConditions(problem.W);
  return solution;
}

Vector StepSystem::gathered(const std::vector<Vector>& nodal) const {
  const std::vector<int>& first = sparse_->firstEquation();
  Vector x(first.back());
  for (size_t b = 0; b < nodal.size(); ++b)
    x.segment(first[b], first[b + 1] - first[b]) = model_.bodies[b].gather(nodal[b]);
  return x;
}

std::vector<Vector> StepSystem::spread(const Vector& x, const Vector& rigid) const {
  const std::vector<int>& first = sparse_->firstEquation();
  std::vector<Vector> nodal;
  for (size_t b = 0; b < bodies_.size(); ++b) {
    nodal.push_back(model_.bodies[b].spread(x.segment(first[b], first[b + 1] - first[b])));
    if (const Matrix& motions = bodies_[b].contact().motions; motions.cols() > 0)
      nodal.back() += motions * motionOf(rigid, b);
  }
  return nodal;
}

ContactSolution StepSystem::holdClosedSparse(const std::vector<Vector>& force, const Vector& slack,
                                             const Iterate& on) const {
  sparse_->setSprings(contact_.proximal);
  const Vector none = Vector::Zero(contact_.G.cols());
  const Vector zero = Vector::Zero(rows());
  SparseContact::Solution held{Vector::Zero(sparse_->firstEquation().back()), none, {}};
  if (sparse_->factorise(joinedSets(on).closed))
    held = sparse_->solve(gathered(force), zero, slack, none, true);
  ContactSolution solution;
  solution.motion = spread(held.motion, held.rigid);
  return solution;
}

std::vector<Vector> StepSystem::condenseBodies(const std::vector<Vector>& force) {
  std::vector<Vector> motion(bodies_.size());
  forEachBody([&](int b) { motion[b] = bodies_[b].condense(force[b]); });
  return motion;
}

void StepSystem::expandBodies(const ContactSolution& contact,
                              const std::function<void(int, const Vector&)>& take) {
  forEachBody([&](int b) {
    take(b, sparse() ? contact.motion[b] : bodies_[b].expand(contact.change, motionOf(contact.rigid, b)));
  });
}

}  // namespace mortier
