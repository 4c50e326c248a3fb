#include <Eigen/LU>
#include <algorithm>

#include "base/blocks.h"
#include "solver/friction_sets.h"
#include "solver/step_system.h"

namespace mortier {
namespace {

/// The linear problem of (contact) when the sets are given: s = 0 on closed conditions, dp = 0 off them, the
/// balance G' dp = 0, as stresses do no work on rigid motions.
ContactSolution holdClosed(const ContactProblem& problem, const Vector& slack, const FrictionSets& sets) {
  constexpr double regularising = 1e-12;  // where conditions or motions are redundant
  ContactSolution solution;
  solution.change = Vector::Zero(slack.size());
  solution.rigid = Vector::Zero(problem.G.cols());
  FrictionWork work;
  const FrictionSystem contact(problem, slack, {}, work);
  const HeldConditions held = contact.heldOn(sets);
  if (held.rows.empty()) return solution;
  const auto n = static_cast<Eigen::Index>(held.rows.size());
  const double compliance = problem.W.diagonal()(held.rows).cwiseAbs().maxCoeff();
  Matrix system = contact.matrix(held, 1, regularising * compliance, regularising / compliance);
  Vector right = Vector::Zero(system.rows());
  right.head(n) = -slack(held.rows);
  const Eigen::PartialPivLU<Eigen::Ref<Matrix>> factor(system);  // in place: it may be large
  const Vector x = factor.solve(right);
  solution.change(held.rows) = x.head(n);
  for (const auto& [row, leader, part] : held.followers) solution.change[row] = part * x[leader];
  solution.rigid = x.tail(problem.G.cols());
  return solution;
}

}  // namespace

std::vector<Response> StepSystem::Factorised::respond(const std::vector<Matrix>& error, const Iterate& on,
                                                      const std::vector<Vector>& slip) const {
  const Model& model = system_->model_;
  std::vector<CondensedBody>& bodies = system_->bodies_;
  std::vector<Response> responses(bodies.size());
  std::vector<Vector> force(bodies.size());
  system_->forEachBody([&](int b) {
    Matrix& stress = responses[b].stress;
    stress.setZero(error[b].rows(), error[b].cols());
    forEachBlock(model.bodies[b].points(), system_->threads_, [&](int begin, int end) {
      for (int i = begin; i < end; ++i) stress.col(i) = -stressOf(bodies[b].law(), error[b].col(i), i);
    });
    force[b] = bodies[b].leftOver(Vector::Zero(model.bodies[b].dofs()), stress);
  });
  ContactSolution contact;
  if (system_->sparse()) {
    contact = system_->holdClosedSparse(force, on);
  } else {
    const std::vector<Vector> motion = system_->condenseBodies(force);
    Vector slack = Vector::Zero(system_->conditions());
    for (size_t b = 0; b < bodies.size(); ++b)
      if (!bodies[b].contact().none()) slack -= bodies[b].contact().C * motion[b];
    const Vector slipped = joined(slip);
    slack.tail(slipped.size()) += slipped;
    contact = holdClosed(system_->contact_, slack, joinedSets(on));
  }
  system_->expandBodies(contact, [&](int b, const Vector& displacement) {
    responses[b].displacement = displacement;
    forEachBlock(model.bodies[b].points(), system_->threads_, [&](int begin, int end) {
      model.bodies[b].addStressOf(displacement, bodies[b].law(), responses[b].stress, begin, end);
    });
  });
  return responses;
}

std::vector<Response> StepSystem::respond(const std::vector<Matrix>& error, const Iterate& on,
                                          const std::vector<Vector>& slip) {
  std::vector<Response> responses(bodies_.size());
  const auto none = [](const auto& part) { return part.isZero(0); };
  if (!model_.any(!std::all_of(error.begin(), error.end(), none)) &&
      std::all_of(slip.begin(), slip.end(), none)) {
    for (size_t b = 0; b < bodies_.size(); ++b)
      responses[b] = {Vector::Zero(model_.bodies[b].dofs()), Matrix::Zero(error[b].rows(), error[b].cols())};
    return responses;
  }
  const Linearised last(*this, 0, Key{});
  StepOutcome again;
  const auto stale = [](const CondensedBody& body) { return body.stale(); };
  // Rows that follow the bodies have been taken anew since the last linear solve.
  const bool otherRows = !sparse() && contact_.W.rows() != conditions();
  if (otherRows || std::any_of(bodies_.begin(), bodies_.end(), stale))
    static_cast<void>(last.factorise(again));
  return last.keepFactors().respond(error, on, slip);
}

}  // namespace mortier
