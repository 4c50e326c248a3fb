#include <Eigen/LU>
#include <algorithm>

#include "base/parallel.h"
#include "solver/friction_sets.h"
#include "solver/step_system.h"

namespace mortier {
namespace {

/// The linear problem of (contact) when the sets are given: s = 0 on closed conditions, dp = 0 off them, the
/// balance G' dp = `balance`, as stresses do no work on rigid motions.
/// \param adjoint  the transposed equations: t of slipping nodes is 0, and s + (+-mu) v = 0 there
ContactSolution holdClosed(const ContactProblem& problem, const Vector& slack, const Vector& balance,
                           const FrictionSets& sets, bool adjoint) {
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
  right.tail(balance.size()) = balance;
  if (adjoint) {
    // With -z for z the matrix has G below and to the right with the signs exchanged.
    for (const auto& [row, leader, part] : held.followers) right[leader] -= part * slack[row];
    right.tail(balance.size()) *= -1;
    system.transposeInPlace();
  }
  const Eigen::PartialPivLU<Eigen::Ref<Matrix>> factor(system);  // in place: it may be large
  const Vector x = factor.solve(right);
  solution.change(held.rows) = x.head(n);
  solution.rigid = (adjoint ? -1 : 1) * x.tail(problem.G.cols());
  for (const auto& [row, leader, part] : held.followers)
    if (!adjoint) solution.change[row] = part * x[leader];
  return solution;
}

}  // namespace

std::vector<Response> StepSystem::Factorised::respond(const Disturbance& to, const Iterate& on) const {
  const Model& model = system_->model_;
  std::vector<CondensedBody>& bodies = system_->bodies_;
  std::vector<Response> responses(bodies.size());
  std::vector<Vector> force(bodies.size());
  system_->forEachBody([&](int b) {
    Matrix& stress = responses[b].stress;
    stress.setZero(to.strain[b].rows(), to.strain[b].cols());
    forEachBlock(model.bodies[b].points(), system_->threads_, [&](int begin, int end) {
      for (int i = begin; i < end; ++i) stress.col(i) = -stressOf(bodies[b].law(), to.strain[b].col(i), i);
    });
    const Vector load = to.force.empty() ? Vector(Vector::Zero(model.bodies[b].dofs())) : to.force[b];
    force[b] = bodies[b].leftOver(load, stress);
  });
  Vector slack = Vector::Zero(system_->conditions());
  const Vector across = joined(to.across);
  const Vector along = joined(to.slip);
  slack.head(across.size()) += across;
  slack.tail(along.size()) += along;
  ContactSolution contact;
  if (system_->sparse()) {
    contact = system_->holdClosedSparse(force, slack, on);
  } else {
    const std::vector<Vector> motion = system_->condenseBodies(force);
    Vector balance = Vector::Zero(system_->contact_.G.cols());
    for (size_t b = 0; b < bodies.size(); ++b) {
      const ContactDofs& dofs = bodies[b].contact();
      if (dofs.none()) continue;
      slack -= dofs.C * motion[b];
      if (!to.force.empty())
        balance.segment(system_->firstMotion_[b], dofs.R.cols()) =
            dofs.rigidForce(model, static_cast<int>(b), to.force[b]);
    }
    contact = holdClosed(system_->contact_, slack, balance, joinedSets(on), to.adjoint);
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
  return last.keepFactors().respond({error, slip}, on);
}

}  // namespace mortier
