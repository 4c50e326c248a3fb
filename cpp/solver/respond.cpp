#include <algorithm>
#include <optional>
#include <utility>

#include "base/parallel.h"
#include "solver/closed_contact.h"
#include "solver/step_system.h"

namespace mortier {
namespace {

/// Forces across contact, per interface, and of ties [N/m].
struct ConstraintForces {
  std::vector<Vector> contact, ties;

  void add(double factor, const ConstraintForces& other) {
    for (size_t k = 0; k < contact.size(); ++k) contact[k] += factor * other.contact[k];
    for (size_t k = 0; k < ties.size(); ++k) ties[k] += factor * other.ties[k];
  }
  /// p' S p
  [[nodiscard]] double stored(const Model& model) const {
    double sum = 0;
    for (size_t k = 0; k < contact.size(); ++k)
      sum += contact[k].dot(model.interfaces[k].yielded(contact[k]));
    for (size_t k = 0; k < ties.size(); ++k) sum += ties[k].dot(model.ties[k].yielded(ties[k]));
    return sum;
  }
};

}  // namespace

std::vector<Response> StepSystem::Factorised::respond(const LinearLoad& to, const Iterate& on) const {
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
    force[b] = load - model.bodies[b].internalForce(stress);
  });
  Vector slack = Vector::Zero(system_->constraints());
  const Vector across = joined(to.across);
  const Vector along = joined(to.slip);
  slack.head(across.size()) += across;
  slack.segment(system_->conditions() - along.size(), along.size()) += along;
  ContactSolution contact;
  if (system_->sparse()) {
    contact = system_->holdClosedSparse(force, slack, on);
  } else {
    const std::vector<Vector> motion = system_->condenseBodies(force);
    Vector balance = Vector::Zero(system_->firstMotion_.back());
    for (size_t b = 0; b < bodies.size(); ++b) {
      const ContactDofs& dofs = bodies[b].contact();
      if (dofs.none()) continue;
      slack -= dofs.C * motion[b];
      if (!to.force.empty())
        balance.segment(system_->firstMotion_[b], dofs.R.cols()) = dofs.rigidForce(to.force[b]);
    }
    contact = system_->holdClosed(ClosedContact(system_->contact_, joinedSets(on), to.adjoint),
                                  {std::move(slack), std::move(balance)});
  }
  system_->expandBodies(contact, [&](int b, const Vector& displacement) {
    responses[b].displacement = displacement;
    forEachBlock(model.bodies[b].points(), system_->threads_, [&](int begin, int end) {
      model.bodies[b].addStressOf(displacement, bodies[b].law(), responses[b].stress, begin, end);
    });
  });
  return responses;
}

// With P the solve on the closed contacts with the factors at hand, which keeps them closed, this is the
// method of conjugate gradients projected on their motions (Gould, Hribar and Nocedal 2001): what contact
// carries of a residual is taken from it, and so are the digits that would be lost beside it. Where
// conditions yield, C d = S dp, forces move with the motions (Dollar, Gould, Schilders and Wathen 2006).
bool StepSystem::Factorised::complete(const Step& step, const Iterate& before, double part, int most,
                                      Iterate& iterate) const {
  constexpr double rounding = 1e-14;  // of the largest force
  const Model& model = system_->model_;
  std::vector<CondensedBody>& bodies = system_->bodies_;
  const size_t count = bodies.size();
  std::vector<Vector> residual(count);  // by dofs
  std::vector<Vector> motion(count);
  std::vector<Vector> along(count);
  std::vector<Matrix> stress(count);  // H^-1 B along
  const ClosedContact contact(system_->contact_, joinedSets(iterate), false);
  const auto dot = [&](const std::vector<Vector>& x, const std::vector<Vector>& y) {
    double sum = 0;
    for (size_t b = 0; b < count; ++b) sum += x[b].dot(y[b]);
    return sum;
  };
  const auto stressAlong = [&](const std::vector<Vector>& d, int b) {
    const Linearisation& law = bodies[b].law();
    stress[b].setZero(law.predictor.rows(), law.predictor.cols());
    forEachBlock(model.bodies[b].points(), system_->threads_,
                 [&](int begin, int end) { model.bodies[b].addStressOf(d[b], law, stress[b], begin, end); });
    return model.bodies[b].internalForce(stress[b]);
  };
  const bool yields = std::ranges::any_of(model.interfaces, &ContactInterface::yields) ||
                      std::ranges::any_of(model.ties, &Tie::elastic);
  ConstraintForces forcesAlong;
  std::vector<Vector> forceAlong(count);
  std::vector<double> forces(count);
  system_->forEachBody([&](int b) {
    const BodyIterate& body = iterate.bodies[b];
    residual[b] = step.loads[b] - model.bodies[b].internalForce(body.stress);
    forces[b] = model.bodies[b].largestForce(body.stress);
    motion[b] = body.increment.minus(before.bodies[b].increment);
    forceAlong[b] = stressAlong(motion, b);
  });
  system_->subtractContact(iterate.contactForce, iterate.frictionForce, residual);
  system_->subtractTies(iterate.tieForce, residual);
  const double enough = part * part * dot(motion, forceAlong);  // of the energy of the solve
  const double noise = rounding * *std::max_element(forces.begin(), forces.end());
  double last = 0;
  for (int iteration = 0;; ++iteration) {
    double largest = 0;
    for (size_t b = 0; b < count; ++b)
      largest = std::max(largest, model.bodies[b].gather(residual[b]).lpNorm<Eigen::Infinity>());
    Vector slack = Vector::Zero(system_->constraints());
    const std::vector<Vector> condensed = system_->condenseBodies(residual);
    for (size_t b = 0; b < count; ++b)
      if (const ContactDofs& dofs = bodies[b].contact(); !dofs.none()) slack -= dofs.C * condensed[b];
    const ContactSolution closed =
        system_->holdClosed(contact, {std::move(slack), Vector::Zero(system_->firstMotion_.back())});
    system_->expandBodies(closed, [&](int b, const Vector& d) { motion[b] = d; });
    ConstraintForces change{system_->parted(closed.change), system_->tiesOf(closed.change)};
    const auto move = [&](const ConstraintForces& by) {
      system_->subtractContact(by.contact, {}, residual);
      system_->subtractTies(by.ties, residual);
      for (size_t k = 0; k < by.contact.size(); ++k) iterate.contactForce[k] += by.contact[k];
      for (size_t k = 0; k < by.ties.size(); ++k) iterate.tieForce[k] += by.ties[k];
    };
    if (!yields) move(change);
    const double size = dot(motion, residual);
    if (!(size > enough) || largest <= noise) return size <= enough || largest <= noise;
    if (iteration == most) return false;
    for (size_t b = 0; b < count; ++b)
      along[b] = iteration == 0 ? motion[b] : Vector(motion[b] + size / last * along[b]);
    if (iteration > 0) change.add(size / last, forcesAlong);
    forcesAlong = std::move(change);
    last = size;
    system_->forEachBody([&](int b) { forceAlong[b] = stressAlong(along, b); });
    double curvature = dot(along, forceAlong);
    if (yields) curvature += forcesAlong.stored(model);
    const double length = size / curvature;
    if (yields) {
      ConstraintForces moved = forcesAlong;
      moved.add(length - 1, forcesAlong);
      move(moved);
    }
    system_->forEachBody([&](int b) {
      residual[b] -= length * forceAlong[b];
      iterate.bodies[b].increment += length * along[b];
      iterate.bodies[b].stress += length * stress[b];
    });
  }
}

ContactSolution StepSystem::holdClosed(const ClosedContact& closed,
                                       const TieElimination::Whole& whole) const {
  const auto [slack, balance] = ties_.reduced(whole);
  return ties_.completed(closed.solve(slack, balance), whole);
}

std::vector<Response> StepSystem::respond(const std::vector<Matrix>& error, const Iterate& on,
                                          const std::vector<Vector>& slip) {
  std::vector<Response> responses(bodies_.size());
  const auto none = [](const auto& part) { return part.isZero(0); };
  if (std::ranges::all_of(error, none) && std::ranges::all_of(slip, none)) {
    for (size_t b = 0; b < bodies_.size(); ++b)
      responses[b] = {Vector::Zero(model_.bodies[b].dofs()), Matrix::Zero(error[b].rows(), error[b].cols())};
    return responses;
  }
  return currentFactors().respond({error, slip}, on);
}

StepSystem::Factorised StepSystem::currentFactors() {
  const Linearised last(*this, 0, Key{});
  StepOutcome again;
  // Rows that follow the bodies have been taken anew since the last linear solve.
  const bool otherRows = !sparse() && !ties_.taken();
  if (otherRows || olderFactors_ || std::ranges::any_of(bodies_, &CondensedBody::stale))
    static_cast<void>(last.factorise(again));
  return last.keepFactors();
}

}  // namespace mortier
