#include "solver/step.h"

#include <Eigen/Eigenvalues>
#include <algorithm>
#include <cmath>
#include <numeric>
#include <sstream>

#include "base/error.h"
#include "base/parallel.h"
#include "base/worst.h"
#include "fem/rigid_modes.h"

namespace mortier {
namespace {

/// Starting threads costs more than it gains below this many triangles.
constexpr int trianglesWorthThreads = 30000;

/// A motion that moves the contact nodes by less than this part of what motions do there is not held by contact.
constexpr double heldFraction = 1e-14;

/// A body that moves by less than this part of a motion has none in it.
constexpr double negligibleMotion = 1e-6;

std::vector<int> numberRows(const Model& model) {
  std::vector<int> first{0};
  for (const ContactInterface& interface : model.interfaces) first.push_back(first.back() + interface.rows());
  return first;
}

}  // namespace

std::vector<Vector> gaps(const Model& model, const State& state0, const Iterate& iterate) {
  std::vector<Vector> result;
  for (size_t k = 0; k < model.interfaces.size(); ++k) {
    const ContactInterface& interface = model.interfaces[k];
    const TwoPartVector& u1 = iterate.bodies[interface.pair().nonmortar.body].increment;
    const TwoPartVector& u2 = iterate.bodies[interface.pair().mortar.body].increment;
    // The parts apart: the first no longer changes where the iteration ends.
    result.emplace_back((state0.gap[k] + interface.jump(u1.high, u2.high)) + interface.jump(u1.low, u2.low));
  }
  return result;
}

std::vector<Vector> solvedGaps(const Model& model, const State& state0, const Iterate& solution) {
  std::vector<Vector> result = gaps(model, state0, solution);
  for (size_t k = 0; k < result.size(); ++k)
    for (Eigen::Index i = 0; i < result[k].size(); ++i)
      if (solution.active[k][i] != 0) result[k][i] = 0;
  return result;
}

ActiveSets startingSets(const State& state0) {
  ActiveSets sets;
  for (const Vector& p : state0.contactForce) {
    const bool none = p.size() == 0 || p.maxCoeff() <= 0;
    std::vector<char> active(p.size());
    for (Eigen::Index i = 0; i < p.size(); ++i) active[i] = none || p[i] > 0 ? 1 : 0;
    sets.push_back(std::move(active));
  }
  return sets;
}

StepSolver::StepSolver(const Model& model, const SolverOptions& options)
    : model_(model), options_(options), firstRow_(numberRows(model)), firstMotion_{0} {
  int triangles = 0;
  systems_.reserve(model.bodies.size());
  for (size_t b = 0; b < model.bodies.size(); ++b) {
    systems_.emplace_back(model, static_cast<int>(b), firstRow_, options);
    firstMotion_.push_back(firstMotion_.back() + static_cast<int>(systems_[b].R().cols()));
    uniqueSolutions_ = uniqueSolutions_ && model.bodies[b].pattern().symmetric;
    triangles += static_cast<int>(model.bodies[b].mesh().triangles.size());
  }
  threads_ = std::make_unique<Threads>(triangles >= trianglesWorthThreads ? options.threads : 1);
  for (BodySystem& system : systems_) system.use(*threads_);
  requireHeld();
}

void StepSolver::requireHeld() {
  contact_.proximal = options_.proximalWeight;
  contact_.G = Matrix::Zero(rows(), firstMotion_.back());
  for (size_t b = 0; b < systems_.size(); ++b)
    contact_.G.middleCols(firstMotion_[b], systems_[b].R().cols()) = systems_[b].C() * systems_[b].R();
  if (contact_.G.cols() == 0) return;
  const Eigen::SelfAdjointEigenSolver<Matrix> eigen(contact_.G.transpose() * contact_.G);
  if (eigen.eigenvalues()[0] <= heldFraction * contact_.G.squaredNorm())
    throw UnheldBodyError("nothing holds " + describeRigid(eigen.eigenvectors().col(0)) +
                          "; a support (ux, uy) or a contact would");
}

std::string StepSolver::looseMotion(const State& state0, const Iterate& iterate) const {
  if (contact_.G.cols() == 0) return "";
  constexpr double touching = 1e-14;
  const std::vector<Vector> u = displacements(state0, iterate);
  Matrix closed = contact_.G;
  for (size_t k = 0; k < model_.interfaces.size(); ++k) {
    const ContactPair& pair = model_.interfaces[k].pair();
    const Vector gap = model_.interfaces[k].gap(u[pair.nonmortar.body], u[pair.mortar.body]);
    const double size = extent(model_.bodies[pair.nonmortar.body].mesh());
    for (Eigen::Index i = 0; i < gap.size(); ++i)
      if (iterate.active[k][i] == 0 && gap[i] < -touching * size) closed.row(firstRow_[k] + i).setZero();
  }
  const Eigen::SelfAdjointEigenSolver<Matrix> eigen(closed.transpose() * closed);
  if (eigen.eigenvalues()[0] > heldFraction * contact_.G.squaredNorm()) return "";
  const Vector z = eigen.eigenvectors().col(0);
  bool untouched = true;
  for (size_t b = 0; b < systems_.size(); ++b) {
    const Vector part = z.segment(firstMotion_[b], systems_[b].motions().cols());
    untouched = untouched && (part.norm() <= negligibleMotion || u[b].isZero(0));
  }
  return untouched ? "" : describeRigid(z);
}

std::string StepSolver::describeRigid(const Vector& z) const {
  std::string text;
  for (size_t b = 0; b < systems_.size(); ++b) {
    const Matrix& motions = systems_[b].motions();
    const Vector part = z.segment(firstMotion_[b], motions.cols());
    if (!(part.norm() > negligibleMotion * z.norm())) continue;
    if (!text.empty()) text += ", ";
    text += "body " + model_.bodies[b].name() + ": " + describeRigidMotion(model_.bodies[b], motions * part);
  }
  return text;
}

Iterate StepSolver::start(const State& state0) const {
  Iterate iterate;
  for (const BodyState& body : state0.bodies)
    iterate.bodies.push_back({TwoPartVector::zero(body.displacement.size()), body.stress, {}});
  iterate.contactForce = state0.contactForce;
  iterate.active = startingSets(state0);
  return iterate;
}

void StepSolver::prescribe(const State& state0, double time, Iterate& iterate) const {
  for (size_t b = 0; b < model_.bodies.size(); ++b)
    model_.bodies[b].prescribeIncrement(state0.time, time, iterate.bodies[b].increment);
}

std::vector<Vector> StepSolver::displacements(const State& state0, const Iterate& iterate) const {
  std::vector<Vector> u;
  for (size_t b = 0; b < model_.bodies.size(); ++b)
    u.push_back(state0.bodies[b].displacement + iterate.bodies[b].increment.value());
  return u;
}

void StepSolver::strain(const StepData& step, int body, BodyIterate& iterate) const {
  const Body& system = model_.bodies[body];
  iterate.strain.resizeLike(iterate.stress);
  system.strain(iterate.increment, step.shift.empty() ? nullptr : &step.shift[body], iterate.strain, 0,
                system.points());
}

/// \returns the material residual, scaled; NaN when any stress is.
double StepSolver::linearise(const State& state0, const StepData& step, Iterate& iterate, bool anticipate) {
  std::vector<double> residual(model_.bodies.size());
  forEachBody([&](int b) {
    BodyIterate& body = iterate.bodies[b];
    residual[b] = systems_[b].linearise({step.weight, state0.bodies[b].stress, body.strain, anticipate},
                                        step.shift.empty() ? nullptr : &step.shift[b], body);
  });
  Worst worst;
  for (const double value : residual) worst.add(value);
  return worst.value();
}

bool StepSolver::factorise(StepOutcome& outcome) {
  std::vector<std::string> failures(systems_.size());
  forEachBody([&](int b) { failures[b] = systems_[b].factorise(); });
  bool changed = contact_.W.rows() != rows();
  for (size_t b = 0; b < systems_.size(); ++b) {
    if (!failures[b].empty()) outcome.reason = failures[b];
    changed = changed || systems_[b].refactorised();
    outcome.factorisations += systems_[b].refactorised() ? 1 : 0;
  }
  if (!outcome.reason.empty()) return false;
  if (!changed) return true;
  contact_.W.setZero(rows(), rows());
  contact_.symmetric = true;
  for (size_t b = 0; b < systems_.size(); ++b) {
    if (!systems_[b].inContact()) continue;
    contact_.symmetric = contact_.symmetric && model_.bodies[b].pattern().symmetric;
    systems_[b].addCompliance(contact_.W);
  }
  return true;
}

void StepSolver::solveLinearised(const State& state0, const std::vector<Vector>& loads,
                                 const ContactSolve& contactSolve, Iterate& iterate, StepOutcome& outcome) {
  // What is out of balance, and the slack as it is.
  std::vector<Vector> force(systems_.size());
  forEachBody([&](int b) { force[b] = loads[b] - model_.bodies[b].internalForce(systems_[b].predictor()); });
  const std::vector<Vector> gap = gaps(model_, state0, iterate);
  contact_.force = 0;
  for (const Vector& before : state0.contactForce)
    if (before.size() > 0) contact_.force = std::max(contact_.force, before.maxCoeff());
  Vector slack(rows());
  Vector p(rows());
  for (size_t k = 0; k < model_.interfaces.size(); ++k) {
    const ContactInterface& interface = model_.interfaces[k];
    const int b1 = interface.pair().nonmortar.body;
    const int b2 = interface.pair().mortar.body;
    interface.subtractForces(iterate.contactForce[k], force[b1], force[b2]);
    slack.segment(firstRow_[k], interface.rows()) = -gap[k];
    p.segment(firstRow_[k], interface.rows()) = iterate.contactForce[k];
  }

  // Condense, and find the contact forces on the interface.
  std::vector<Vector> motion(systems_.size());
  forEachBody([&](int b) { motion[b] = systems_[b].condense(force[b]); });
  Vector balance(contact_.G.cols());
  for (size_t b = 0; b < systems_.size(); ++b) {
    if (!systems_[b].inContact()) continue;
    slack -= systems_[b].C() * motion[b];
    balance.segment(firstMotion_[b], systems_[b].R().cols()) = systems_[b].rigidForce(loads[b]);
  }
  balance -= contact_.G.transpose() * p;
  const ContactSolution contact = contactSolve(slack, p, balance, joined(iterate.active));
  if (contact.outcome == ContactSolution::Outcome::cycled) {
    outcome.reason = "the contact problem of the linearised step has no solution";
    return;
  }
  if (contact.outcome == ContactSolution::Outcome::capped) {
    outcome.reason = "the contact problem of the linearised step was given up after the work of " +
                     std::to_string(static_cast<int>(workLimit)) + " factorisations";
    return;
  }
  if (contact.outcome == ContactSolution::Outcome::unbalanced) {
    outcome.unheld = true;
    outcome.reason = "contact cannot hold " + describeRigid(contact.rigid);
    return;
  }

  // Expand: displacement and stress.
  forEachBody([&](int b) {
    systems_[b].expand(contact.change, contact.rigid.segment(firstMotion_[b], systems_[b].R().cols()),
                       iterate.bodies[b]);
  });
  for (size_t k = 0; k < model_.interfaces.size(); ++k) {
    const int rows = model_.interfaces[k].rows();
    iterate.contactForce[k] = (p + contact.change).segment(firstRow_[k], rows);
    iterate.active[k].assign(contact.active.begin() + firstRow_[k],
                             contact.active.begin() + firstRow_[k] + rows);
  }
}

void StepSolver::solveLinearised(const State& state0, const std::vector<Vector>& loads, Iterate& iterate,
                                 StepOutcome& outcome) {
  const ContactSolve pivoting = [this](const Vector& slack, const Vector& p0, const Vector& balance,
                                       const std::vector<char>& active) {
    ContactSolution solution = solveContact(contact_, slack, p0, balance, active);
    special_.idle = std::max(special_.idle, solution.idle);
    if (solution.dependent && special_.dependent == 0) special_.dependent = dependentConditions(contact_.W);
    return solution;
  };
  solveLinearised(state0, loads, pivoting, iterate, outcome);
  iterate.wrongForce = 0;
  for (Vector& p : iterate.contactForce) {
    if (p.size() > 0) iterate.wrongForce = std::max(iterate.wrongForce, -p.minCoeff());
    p = p.cwiseMax(0);
  }
}

Certificate StepSolver::certify(const State& state0, const std::vector<Vector>& loads, const Iterate& iterate,
                                double materialResidual) const {
  constexpr double roundingOfMotion = 1e-15;
  Worst force;
  Worst length;  // gaps are differences of displacements
  Worst rounding;
  std::vector<Vector> residual;
  const std::vector<Vector> u = displacements(state0, iterate);
  for (size_t b = 0; b < model_.bodies.size(); ++b) {
    const Vector internal = model_.bodies[b].internalForce(iterate.bodies[b].stress);
    force.add(model_.bodies[b].largestForce(iterate.bodies[b].stress));
    force.add(model_.bodies[b].largestForce(state0.bodies[b].stress));  // of which rounding is left
    force.add(loads[b]);
    residual.push_back(loads[b] - internal);
    // A body that moves without any load and does not flow has forces that are nothing but rounding.
    if (systems_[b].law().elastic == model_.bodies[b].points())
      force.add(roundingOfMotion * systems_[b].moduli().lpNorm<Eigen::Infinity>() *
                iterate.bodies[b].increment.high.lpNorm<Eigen::Infinity>());
    length.add(extent(model_.bodies[b].mesh()));
    length.add(u[b]);
    rounding.add(systems_[b].rounding(state0.bodies[b].stress, iterate.bodies[b], u[b]));
  }
  Worst contactForce;
  for (const Vector& p : iterate.contactForce) contactForce.add(p);
  Worst gapOnActive;
  Worst openPenetration;
  Worst complementarity;
  for (size_t k = 0; k < model_.interfaces.size(); ++k) {
    const ContactInterface& interface = model_.interfaces[k];
    const int b1 = interface.pair().nonmortar.body;
    const int b2 = interface.pair().mortar.body;
    const Vector& p = iterate.contactForce[k];
    interface.subtractForces(p, residual[b1], residual[b2]);
    const Vector g = interface.gap(u[b1], u[b2]) / length.value();
    for (Eigen::Index i = 0; i < g.size(); ++i) {
      if (iterate.active[k][i] != 0)
        gapOnActive.add(std::abs(g[i]));
      else
        openPenetration.add(g[i]);
      if (contactForce.value() != 0) complementarity.add(std::abs(p[i] / contactForce.value() * g[i]));
    }
  }
  Worst balance;
  for (size_t b = 0; b < model_.bodies.size(); ++b) balance.add(model_.bodies[b].gather(residual[b]));
  const auto overForce = [&](double value) { return value == 0 ? 0 : value / force.value(); };
  Certificate result;
  result.forceBalance = overForce(balance.value());
  result.materialResidual = materialResidual;
  result.gapOnActive = gapOnActive.value();
  result.openPenetration = openPenetration.value();
  result.sign = overForce(iterate.wrongForce);
  result.complementarity = complementarity.value();
  result.rounding = rounding.value();
  return result;
}

StepOutcome StepSolver::newton(const State& state0, const StepData& step, const NewtonLimits& limits,
                               Iterate& iterate) {
  // Beyond this many times the stresses that are there, or the yield stress, an iterate does not come back.
  constexpr double hopeless = 1e3;
  constexpr int patience = 2;
  int outOfBalance = 0;
  StepOutcome outcome;
  prescribe(state0, step.time, iterate);
  const std::vector<Vector>& loads = loadsAt(step.time);
  StepData elastic;
  if (limits.elasticFirst) elastic = step;
  elastic.weight = 0;
  for (int iteration = 0;; ++iteration) {
    const bool asElastic = limits.elasticFirst && iteration == 0;
    const double residual = linearise(state0, asElastic ? elastic : step, iterate, limits.anticipate);
    if (iteration > 0 && residual <= limits.tolerance) {
      outcome.certificate = certify(state0, loads, iterate, residual);
      if (outcome.certificate.forceBalance <= std::max(balanceTolerance, limits.tolerance * 1e-2)) {
        outcome.converged = true;
        return outcome;
      }
      // The law holds and equilibrium does not, again and again: the linear solves are to blame.
      if (++outOfBalance == patience)
        for (BodySystem& system : systems_) system.useLibraries();
    }
    const auto turns = [&] { return limits.turning && iteration == 1 && flows(state0); };
    if (iteration == limits.iterations || !std::isfinite(residual) ||
        (residual > hopeless && (iteration >= 2 || turns()))) {
      std::ostringstream reason;
      reason << "Newton's method did not converge in " << iteration << " iterations, material residual "
             << residual;
      outcome.reason = reason.str();
      return outcome;
    }
    ++outcome.iterations;
    if (!factorise(outcome)) return outcome;
    solveLinearised(state0, loads, iterate, outcome);
    if (!outcome.reason.empty()) return outcome;
  }
}

}  // namespace mortier
