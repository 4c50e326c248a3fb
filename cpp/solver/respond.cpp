#include <Eigen/LU>
#include <algorithm>

#include "base/blocks.h"
#include "solver/step_system.h"

namespace mortier {
namespace {

/// The conditions of all interfaces that are held: closed, or sticking where there is friction; and those
/// along the line that slip, whose force is a part of that across.
struct Held {
  std::vector<int> conditions;
  struct Follower {
    int condition;
    Eigen::Index leader;  ///< among the held ones
    double part;
  };
  std::vector<Follower> followers;
};

/// The linear problem that is left of (contact) when the active set is given: s = 0 on it, dp = 0 off it, the
/// balance G' dp = r. A little compliance keeps it regular where conditions or motions are redundant.
Matrix closedSystem(const ContactProblem& problem, const Held& held) {
  constexpr double little = 1e-12;
  const std::vector<int>& closed = held.conditions;
  const auto n = static_cast<Eigen::Index>(closed.size());
  const Eigen::Index motions = problem.G.cols();
  const Matrix G = problem.G(closed, Eigen::all);
  Matrix system = Matrix::Zero(n + motions, n + motions);
  system.topLeftCorner(n, n) = problem.W(closed, closed);
  const double compliance = system.diagonal().cwiseAbs().maxCoeff();
  system.topLeftCorner(n, n).diagonal().array() += little * compliance;
  system.topRightCorner(n, motions) = -G;
  system.bottomLeftCorner(motions, n) = G.transpose();
  for (const auto& [condition, leader, part] : held.followers) {
    system.col(leader).head(n) += part * problem.W(closed, condition);
    system.col(leader).tail(motions) += part * problem.G.row(condition).transpose();
  }
  system.bottomRightCorner(motions, motions).diagonal().array() += little / compliance;
  return system;
}

Held heldConditions(const Iterate& on, const FrictionRows& friction) {
  Held held;
  std::vector<Eigen::Index> place;  // of a condition across among the held ones
  int condition = 0;
  for (const std::vector<char>& set : on.active)
    for (const char holds : set) {
      place.push_back(holds != 0 ? static_cast<Eigen::Index>(held.conditions.size()) : -1);
      if (holds != 0) held.conditions.push_back(condition);
      ++condition;
    }
  Eigen::Index row = 0;
  for (const std::vector<signed char>& slipping : on.slipping)
    for (const signed char sign : slipping) {
      const Eigen::Index leader = place[friction.node[row]];
      const double part = sign * friction.law.coefficient[row];
      if (sign == 0 && (leader >= 0 || friction.law.limit[row] > 0))
        held.conditions.push_back(condition);
      else if (leader >= 0 && part != 0)
        held.followers.push_back({condition, leader, part});
      ++condition;
      ++row;
    }
  return held;
}

ContactSolution holdClosed(const ContactProblem& problem, const Vector& slack, const Held& held) {
  ContactSolution solution;
  solution.change = Vector::Zero(slack.size());
  solution.rigid = Vector::Zero(problem.G.cols());
  const std::vector<int>& closed = held.conditions;
  if (closed.empty()) return solution;
  const auto n = static_cast<Eigen::Index>(closed.size());
  const Eigen::Index motions = problem.G.cols();
  Vector right(n + motions);
  right << -slack(closed), Vector::Zero(motions);  // stresses do no work on rigid motions
  Matrix system = closedSystem(problem, held);
  const Eigen::PartialPivLU<Eigen::Ref<Matrix>> factor(system);  // in place: it may be large
  const Vector x = factor.solve(right);
  solution.change(closed) = x.head(n);
  for (const auto& [condition, leader, part] : held.followers) solution.change[condition] = part * x[leader];
  solution.rigid = x.tail(motions);
  return solution;
}

}  // namespace

std::vector<Response> StepSystem::Factorised::respond(const std::vector<Matrix>& error, const Iterate& on,
                                                      const std::vector<Vector>& slip) const {
  if (system_->sparse()) return system_->respondSparse(error, on);
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
  const std::vector<Vector> motion = system_->condenseBodies(force);
  Vector slack = Vector::Zero(system_->conditions());
  for (size_t b = 0; b < bodies.size(); ++b)
    if (!bodies[b].contact().none()) slack -= bodies[b].contact().C * motion[b];
  Eigen::Index row = system_->rows();
  for (const Vector& part : slip) {
    slack.segment(row, part.size()) += part;
    row += part.size();
  }
  const ContactSolution contact =
      holdClosed(system_->contact_, slack, heldConditions(on, system_->friction_));
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
  if (std::any_of(bodies_.begin(), bodies_.end(), stale)) static_cast<void>(last.factorise(again));
  return last.keepFactors().respond(error, on, slip);
}

}  // namespace mortier
