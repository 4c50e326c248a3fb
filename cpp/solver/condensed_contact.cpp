// The contact problem of a linear solve without friction, and for long lines.
#include <algorithm>
#include <utility>

#include "solver/sparse_sets.h"
#include "solver/step_system.h"

namespace mortier {

bool StepSystem::Factorised::solve(const Step& step, Iterate& iterate, StepOutcome& outcome) const {
  Condensed condensed = condense(step, iterate);
  const ContactSolution contact = condensed.solveContact();
  return std::move(condensed).expand(contact, iterate, outcome);
}

ContactSolution StepSystem::Condensed::solveContact() const {
  if (system_->hasFriction()) return solveFriction();
  if (system_->sparse()) return solveSparse();
  ContactSolution solution = mortier::solveContact(system_->contact_, slack, p0, balance, active);
  SpecialConditions& special = system_->special_;
  special.idle = std::max(special.idle, solution.idle);
  if (solution.dependent && special.dependent == 0)
    special.dependent = dependentConditions(system_->contact_.W);
  return solution;
}

ContactSolution StepSystem::Condensed::solveSparse() const {
  Vector motion;
  SparseContact& matrix = *system_->sparse_;
  ContactSolution solution = mortier::solveSparse(matrix, system_->contact_, system_->gathered(force), slack,
                                                  p0, balance, active, motion);
  system_->special_.idle = std::max(system_->special_.idle, solution.idle);
  if (solution.outcome != ContactSolution::Outcome::solved) return solution;
  solution.motion = system_->spread(motion, solution.rigid);
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

std::vector<Response> StepSystem::respondSparse(const std::vector<Matrix>& error, const Iterate& on) {
  std::vector<Response> responses(bodies_.size());
  std::vector<Vector> force(bodies_.size());
  forEachBody([&](int b) {
    Matrix& stress = responses[b].stress;
    stress.resizeLike(error[b]);
    for (int i = 0; i < stress.cols(); ++i) stress.col(i) = -stressOf(bodies_[b].law(), error[b].col(i), i);
    force[b] = -model_.bodies[b].internalForce(stress);
  });
  std::vector<char> active;
  for (const std::vector<char>& part : on.active) active.insert(active.end(), part.begin(), part.end());
  sparse_->setSprings(contact_.proximal);
  const Vector none = Vector::Zero(contact_.G.cols());
  SparseContact::Solution held{Vector::Zero(sparse_->firstEquation().back()), none, {}};
  const Vector zero = Vector::Zero(rows());
  if (sparse_->factorise(active)) held = sparse_->solve(gathered(force), zero, zero, none, true);
  const std::vector<Vector> displacement = spread(held.motion, held.rigid);
  forEachBody([&](int b) {
    Response& response = responses[b];
    response.displacement = displacement[b];
    model_.bodies[b].addStressOf(displacement[b], bodies_[b].law(), response.stress, 0,
                                 model_.bodies[b].points());
  });
  return responses;
}

}  // namespace mortier
