#include <Eigen/LU>
#include <algorithm>

#include "solver/step.h"

namespace mortier {
namespace {

/// The linear problem that is left of (contact) when the active set is given: s = 0 on it, dp = 0 off it, the
/// balance G' dp = r. A little compliance keeps it regular where conditions or motions are redundant.
Matrix closedSystem(const ContactProblem& problem, const std::vector<int>& closed) {
  constexpr double little = 1e-12;
  const auto n = static_cast<Eigen::Index>(closed.size());
  const Eigen::Index motions = problem.G.cols();
  const Matrix G = problem.G(closed, Eigen::all);
  Matrix system = Matrix::Zero(n + motions, n + motions);
  system.topLeftCorner(n, n) = problem.W(closed, closed);
  const double compliance = system.diagonal().cwiseAbs().maxCoeff();
  system.topLeftCorner(n, n).diagonal().array() += little * compliance;
  system.topRightCorner(n, motions) = -G;
  system.bottomLeftCorner(motions, n) = G.transpose();
  system.bottomRightCorner(motions, motions).diagonal().array() += little / compliance;
  return system;
}

std::vector<int> closedConditions(const std::vector<char>& active) {
  std::vector<int> closed;
  for (size_t i = 0; i < active.size(); ++i)
    if (active[i] != 0) closed.push_back(static_cast<int>(i));
  return closed;
}

ContactSolution holdClosed(const ContactProblem& problem, const Vector& slack, const Vector& balance,
                           const std::vector<char>& active) {
  ContactSolution solution;
  solution.change = Vector::Zero(slack.size());
  solution.rigid = Vector::Zero(problem.G.cols());
  const std::vector<int> closed = closedConditions(active);
  if (closed.empty()) return solution;
  const auto n = static_cast<Eigen::Index>(closed.size());
  const Eigen::Index motions = problem.G.cols();
  Vector right(n + motions);
  right << -slack(closed), balance;
  Matrix system = closedSystem(problem, closed);
  const Eigen::PartialPivLU<Eigen::Ref<Matrix>> factor(system);  // in place: it may be large
  const Vector x = factor.solve(right);
  solution.change(closed) = x.head(n);
  solution.rigid = x.tail(motions);
  return solution;
}

}  // namespace

/// The sets of all interfaces as one.
std::vector<char> StepSolver::joined(const ActiveSets& active) const {
  std::vector<char> set;
  set.reserve(rows());
  for (const std::vector<char>& part : active) set.insert(set.end(), part.begin(), part.end());
  return set;
}

std::vector<Response> StepSolver::respond(const std::vector<Matrix>& error, const ActiveSets& active) {
  std::vector<Response> responses(systems_.size());
  if (std::all_of(error.begin(), error.end(), [](const Matrix& e) { return e.isZero(0); })) {
    for (size_t b = 0; b < systems_.size(); ++b)
      responses[b] = {Vector::Zero(model_.bodies[b].dofs()),
                      Matrix::Zero(model_.bodies[b].material().components(), error[b].cols())};
    return responses;
  }
  // The last iteration may have moved a point across yield after its tangent was factorised.
  if (std::any_of(systems_.begin(), systems_.end(),
                  [](const BodySystem& system) { return system.stale(); })) {
    StepOutcome again;
    factorise(again);
  }
  std::vector<Vector> motion(systems_.size());
  forEachBody([&](int b) {
    responses[b].stress = -systems_[b].stressOf(error[b]);
    motion[b] = systems_[b].condense(-model_.bodies[b].internalForce(responses[b].stress));
  });
  Vector slack = Vector::Zero(rows());
  const Vector balance = Vector::Zero(contact_.G.cols());  // stresses do no work on rigid motions
  for (size_t b = 0; b < systems_.size(); ++b) {
    if (!systems_[b].inContact()) continue;
    slack -= systems_[b].C() * motion[b];
  }
  const ContactSolution contact = holdClosed(contact_, slack, balance, joined(active));
  forEachBody([&](int b) {
    responses[b].displacement = systems_[b].displacementOf(
        contact.change, contact.rigid.segment(firstMotion_[b], systems_[b].R().cols()));
    model_.bodies[b].addStressOf(responses[b].displacement, systems_[b].law(), responses[b].stress, 0,
                                 model_.bodies[b].points());
  });
  return responses;
}

int StepSolver::determinantSign(const ActiveSets& active) const {
  int sign = 1;
  for (const BodySystem& system : systems_) sign *= system.determinantSign();
  const std::vector<int> closed = closedConditions(joined(active));
  return closed.empty() ? sign
                        : sign * mortier::determinantSign(closedSystem(contact_, closed).partialPivLu());
}

SolverMemory StepSolver::memory() const {
  SolverMemory memory;
  for (const BodySystem& system : systems_) {
    memory.libraries.push_back(system.usesLibraries() ? 1 : 0);
    memory.elasticFactors.push_back(system.elasticFactors() ? 1 : 0);
  }
  return memory;
}

void StepSolver::resume(const SolverMemory& memory) {
  for (size_t b = 0; b < memory.libraries.size(); ++b) {
    if (memory.libraries[b] != 0) systems_[b].useLibraries();
    if (memory.elasticFactors[b] != 0) systems_[b].resumeElastic();
  }
}

}  // namespace mortier
