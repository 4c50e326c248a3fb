// The contact problem of a linear solve without friction, and for long lines.
#include <algorithm>
#include <utility>

#include "solver/step_system.h"

namespace mortier {

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

}  // namespace mortier
