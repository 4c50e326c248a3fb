#include "solver/step.h"

#include <Eigen/Cholesky>
#include <Eigen/Eigenvalues>
#include <Eigen/LU>
#include <algorithm>
#include <cmath>
#include <deque>
#include <sstream>

#include "base/double_double.h"
#include "base/error.h"
#include "fem/rigid_modes.h"

namespace mortier {

/// A body's side of the linear system, and its rows of C over the contact dofs that are kept.
struct StepSolver::BodySystem {
  std::vector<int> kept;  ///< equations of the contact dofs
  Matrix C;               ///< all contact rows x kept
  Matrix motions;         ///< rigid motions that the supports leave free, dofs x motions
  Matrix R;               ///< the same on the kept equations, orthonormal
  int firstMotion = 0;    ///< among the motions of all bodies
  std::unique_ptr<CondensingSolver> solver;
  std::unique_ptr<CondensingSolver> fallback;
  std::vector<double> values;
  bool factorised = false;

  Linearisation law;

  Eigen::LLT<Matrix> cholesky;  ///< of S where the tangent is symmetric
  Eigen::PartialPivLU<Matrix> lu;
  Matrix compliance;  ///< S^-1 C'
  Vector residual;    ///< right-hand side over equations, condensed in place

  [[nodiscard]] Matrix solveSchur(const Matrix& f, bool symmetric) const {
    return symmetric ? Matrix(cholesky.solve(f)) : Matrix(lu.solve(f));
  }
};

namespace {

/// Force balance asked of a converged step; far above rounding, far below what any result shows.
constexpr double balanceTolerance = 1e-11;
/// A motion that moves the contact nodes by less than this part of the others is not held by contact.
constexpr double motionTolerance = 1e-14;

/// Rows of C of one interface side as (row, dof, value).
template <class Visit>
void forEachEntryOfC(const ContactInterface& interface, int body, Visit visit) {
  if (interface.pair().nonmortar.body == body)
    for (int i = 0; i < interface.rows(); ++i)
      for (int c = 0; c < 2; ++c) visit(i, 2 * interface.nonmortarNodes()[i] + c, interface.normal()[c]);
  if (interface.pair().mortar.body == body)
    for (size_t j = 0; j < interface.mortarNodes().size(); ++j)
      for (int i = 0; i < interface.rows(); ++i)
        for (int c = 0; c < 2; ++c)
          visit(i, 2 * interface.mortarNodes()[j] + c, -interface.coupling().A(i, j) * interface.normal()[c]);
}

}  // namespace

StepSolver::StepSolver(const Model& model, const SolverOptions& options) : model_(model), options_(options) {
  for (const ContactInterface& interface : model.interfaces) {
    firstRow_.push_back(rows_);
    rows_ += interface.rows();
  }
  for (size_t b = 0; b < model.bodies.size(); ++b) {
    const Body& body = model.bodies[b];
    auto system = std::make_unique<BodySystem>();
    std::vector<int> column(body.freeDofs(), -1);
    for (const ContactInterface& interface : model.interfaces)
      forEachEntryOfC(interface, static_cast<int>(b), [&](int, int dof, double value) {
        const int equation = body.equations()[dof];
        if (equation < 0 || value == 0 || column[equation] >= 0) return;
        column[equation] = static_cast<int>(system->kept.size());
        system->kept.push_back(equation);
      });
    system->C = Matrix::Zero(rows_, static_cast<Eigen::Index>(system->kept.size()));
    for (size_t k = 0; k < model.interfaces.size(); ++k)
      forEachEntryOfC(model.interfaces[k], static_cast<int>(b), [&](int row, int dof, double value) {
        const int equation = body.equations()[dof];
        if (equation >= 0 && value != 0) system->C(firstRow_[k] + row, column[equation]) += value;
      });
    system->solver = options.linear == LinearEngine::multifrontal
                         ? multifrontalSolver(body.pattern(), system->kept)
                         : suiteSparseSolver(body.pattern(), system->kept);
    system->motions = rigidModes(body);
    system->law.predictor.resize(body.material().components(), body.points());
    system->law.moduli.resize(9, body.points());
    systems_.push_back(std::move(system));
  }
  findRigidMotions();
}

void StepSolver::findRigidMotions() {
  int motions = 0;
  for (auto& system : systems_) {
    system->firstMotion = motions;
    motions += static_cast<int>(system->motions.cols());
  }
  contact_.G = Matrix::Zero(rows_, motions);
  for (size_t b = 0; b < systems_.size(); ++b) {
    BodySystem& system = *systems_[b];
    if (system.motions.cols() == 0) continue;
    const Body& body = model_.bodies[b];
    // On the contact dofs, then orthonormal there: motions = (motions on contact dofs) T^-1.
    Matrix onKept(system.kept.size(), system.motions.cols());
    for (int dof = 0; dof < body.dofs(); ++dof)
      for (size_t i = 0; i < system.kept.size(); ++i)
        if (body.equations()[dof] == system.kept[i]) onKept.row(i) = system.motions.row(dof);
    const Eigen::SelfAdjointEigenSolver<Matrix> eigen(onKept.transpose() * onKept);
    const double largest = std::max(1.0, eigen.eigenvalues().maxCoeff());
    for (Eigen::Index i = 0; i < eigen.eigenvalues().size(); ++i)
      if (eigen.eigenvalues()[i] <= motionTolerance * largest)
        throw UnheldBodyError("body " + body.name() + ": nothing holds its " +
                              describeRigidMotion(body, system.motions * eigen.eigenvectors().col(i)) +
                              "; a support (ux, uy) or a contact would");
    const Matrix T = eigen.eigenvectors() * eigen.eigenvalues().cwiseSqrt().cwiseInverse().asDiagonal();
    system.motions *= T;
    system.R = onKept * T;
    contact_.G.middleCols(system.firstMotion, system.R.cols()) = system.C * system.R;
  }
  if (motions == 0) return;
  const Eigen::SelfAdjointEigenSolver<Matrix> eigen(contact_.G.transpose() * contact_.G);
  if (eigen.eigenvalues()[0] <= motionTolerance * eigen.eigenvalues().maxCoeff())
    throw UnheldBodyError("nothing holds " + describeRigid(eigen.eigenvectors().col(0)) +
                          "; a support (ux, uy) or a contact would");
}

std::string StepSolver::describeRigid(const Vector& z) const {
  std::string text;
  for (size_t b = 0; b < systems_.size(); ++b) {
    const Matrix& motions = systems_[b]->motions;
    if (motions.cols() == 0) continue;
    const Vector part = z.segment(systems_[b]->firstMotion, motions.cols());
    if (part.norm() < 1e-6 * z.norm()) continue;
    if (!text.empty()) text += ", ";
    text += "body " + model_.bodies[b].name() + ": " + describeRigidMotion(model_.bodies[b], motions * part);
  }
  return text;
}

StepSolver::~StepSolver() = default;

Iterate StepSolver::start(const State& state0) const {
  Iterate iterate;
  for (const BodyState& body : state0.bodies)
    iterate.bodies.push_back(
        {Vector::Zero(body.displacement.size()), Vector::Zero(body.displacement.size()), body.stress, {}});
  iterate.contactForce = state0.contactForce;
  for (const Vector& p : state0.contactForce) {
    const bool none = p.size() == 0 || p.maxCoeff() <= 0;
    std::vector<char> active(p.size());
    for (Eigen::Index i = 0; i < p.size(); ++i) active[i] = none || p[i] > 0 ? 1 : 0;
    iterate.active.push_back(std::move(active));
  }
  return iterate;
}

void StepSolver::prescribe(const State& state0, double time, Iterate& iterate) const {
  for (size_t b = 0; b < model_.bodies.size(); ++b) {
    Vector u1 = state0.bodies[b].displacement;
    model_.bodies[b].prescribe(time, u1);
    const auto& equations = model_.bodies[b].equations();
    for (size_t dof = 0; dof < equations.size(); ++dof)
      if (equations[dof] < 0) {
        iterate.bodies[b].increment[dof] = u1[dof] - state0.bodies[b].displacement[dof];
        iterate.bodies[b].small[dof] = 0;
      }
  }
}

/// \returns the material residual, scaled.
double StepSolver::linearise(const State& state0, const StepData& step, Iterate& iterate, bool anticipate) {
  double worst = 0;
  for (size_t b = 0; b < model_.bodies.size(); ++b) {
    const Body& body = model_.bodies[b];
    BodySystem& system = *systems_[b];
    body.strain(iterate.bodies[b].increment, iterate.bodies[b].small, iterate.bodies[b].strain);
    if (!step.shift.empty()) iterate.bodies[b].strain -= step.shift[b];
    const double residual = body.material().linearise(
        {step.weight, state0.bodies[b].stress, iterate.bodies[b].strain, anticipate},
        iterate.bodies[b].stress, system.law, 0, body.points());
    double scale = body.material().stressScale();
    if (scale == 0) scale = system.law.predictor.cwiseAbs().maxCoeff();
    if (residual != 0) worst = std::max(worst, residual / scale);
    if (!std::isfinite(residual)) return residual;
  }
  return worst;
}

bool StepSolver::factorise(StepOutcome& outcome) {
  bool changed = contact_.W.rows() != rows_;
  for (size_t b = 0; b < model_.bodies.size(); ++b) {
    const Body& body = model_.bodies[b];
    BodySystem& system = *systems_[b];
    if (system.factorised && body.material().linear()) continue;
    changed = true;
    body.tangent(system.law.moduli, system.values);
    ++outcome.factorisations;
    system.factorised = system.solver->factorise(system.values);
    if (!system.factorised) {
      outcome.reason = "body " + body.name() + ": its tangent is singular with its contact nodes held";
      return false;
    }
    if (system.kept.empty()) continue;
    // Rigid motions get a stiffness of their own; as z carries them it never acts.
    Matrix S = system.solver->schurComplement();
    if (system.R.cols() > 0) S += S.diagonal().maxCoeff() * system.R * system.R.transpose();
    if (body.pattern().symmetric) {
      system.cholesky.compute(S);
      if (system.cholesky.info() != Eigen::Success) {
        system.factorised = false;
        outcome.reason = "body " + body.name() + ": its tangent is not positive definite";
        return false;
      }
    } else {
      system.lu.compute(S);
    }
    system.compliance = system.solveSchur(system.C.transpose(), body.pattern().symmetric);
  }
  if (changed) {
    contact_.W = Matrix::Zero(rows_, rows_);
    contact_.symmetric = true;
    for (size_t b = 0; b < systems_.size(); ++b) {
      contact_.symmetric = contact_.symmetric && model_.bodies[b].pattern().symmetric;
      if (!systems_[b]->kept.empty()) contact_.W += systems_[b]->C * systems_[b]->compliance;
    }
  }
  return true;
}

void StepSolver::solveLinearised(const State& state0, const std::vector<Vector>& loads, Iterate& iterate,
                                 StepOutcome& outcome) {
  std::vector<Vector> residual;
  for (size_t b = 0; b < model_.bodies.size(); ++b)
    residual.push_back(loads[b] - model_.bodies[b].internalForce(systems_[b]->law.predictor));
  Vector slack(rows_);
  Vector balance(contact_.G.cols());
  Vector p(rows_);
  std::vector<char> active;
  for (size_t k = 0; k < model_.interfaces.size(); ++k) {
    const ContactInterface& interface = model_.interfaces[k];
    const int b1 = interface.pair().nonmortar.body;
    const int b2 = interface.pair().mortar.body;
    interface.subtractForces(iterate.contactForce[k], residual[b1], residual[b2]);
    const auto displacement = [&](int b) {
      return Vector(state0.bodies[b].displacement + (iterate.bodies[b].increment + iterate.bodies[b].small));
    };
    slack.segment(firstRow_[k], interface.rows()) = -interface.gap(displacement(b1), displacement(b2));
    p.segment(firstRow_[k], interface.rows()) = iterate.contactForce[k];
    active.insert(active.end(), iterate.active[k].begin(), iterate.active[k].end());
  }

  // Condense, and find the contact forces on the interface.
  for (size_t b = 0; b < model_.bodies.size(); ++b) {
    const Body& body = model_.bodies[b];
    BodySystem& system = *systems_[b];
    system.residual.resize(body.freeDofs());
    for (int dof = 0; dof < body.dofs(); ++dof)
      if (body.equations()[dof] >= 0) system.residual[body.equations()[dof]] = residual[b][dof];
    system.solver->condense(system.residual);
    if (system.kept.empty()) continue;
    const Vector f = system.residual(system.kept);
    slack -= system.C * system.solveSchur(f, body.pattern().symmetric);
    if (system.R.cols() > 0) balance.segment(system.firstMotion, system.R.cols()) = system.R.transpose() * f;
  }
  const ContactSolution contact = solveContact(contact_, slack, p, balance, active);
  if (contact.outcome == ContactSolution::Outcome::cycled) {
    outcome.reason = "the contact problem of the linearised step has no solution";
    return;
  }
  if (contact.outcome == ContactSolution::Outcome::unbalanced) {
    outcome.unheld = true;
    outcome.reason = "contact cannot hold " + describeRigid(contact.rigid);
    return;
  }

  // Expand: displacement and stress.
  for (size_t b = 0; b < model_.bodies.size(); ++b) {
    const Body& body = model_.bodies[b];
    BodySystem& system = *systems_[b];
    if (!system.kept.empty()) {
      const Vector f = Vector(system.residual(system.kept)) - system.C.transpose() * contact.change;
      Vector x = system.solveSchur(f, body.pattern().symmetric);
      if (system.R.cols() > 0) {
        x -= system.R * (system.R.transpose() * x);
        x += system.R * contact.rigid.segment(system.firstMotion, system.R.cols());
      }
      system.residual(system.kept) = x;
    }
    system.solver->expand(system.residual);
    Vector d = Vector::Zero(body.dofs());
    BodyIterate& unknowns = iterate.bodies[b];
    for (int dof = 0; dof < body.dofs(); ++dof) {
      if (body.equations()[dof] < 0) continue;
      d[dof] = system.residual[body.equations()[dof]];
      const DoubleDouble u = DoubleDouble::sum(unknowns.increment[dof], d[dof]);
      unknowns.increment[dof] = u.high;
      unknowns.small[dof] += u.low;
    }
    unknowns.stress = system.law.predictor;
    body.addStressOf(d, system.law.moduli, unknowns.stress);
  }
  for (size_t k = 0; k < model_.interfaces.size(); ++k) {
    const int rows = model_.interfaces[k].rows();
    iterate.contactForce[k] = (p + contact.change).segment(firstRow_[k], rows).cwiseMax(0);
    iterate.active[k].assign(contact.active.begin() + firstRow_[k],
                             contact.active.begin() + firstRow_[k] + rows);
  }
}

Certificate StepSolver::certify(const State& state0, const std::vector<Vector>& loads, const Iterate& iterate,
                                double materialResidual) const {
  Certificate result;
  result.materialResidual = materialResidual;
  double force = 0;
  double extentOfAll = 0;
  std::vector<Vector> residual;
  for (size_t b = 0; b < model_.bodies.size(); ++b) {
    const Vector internal = model_.bodies[b].internalForce(iterate.bodies[b].stress);
    force = std::max({force, internal.cwiseAbs().maxCoeff(), loads[b].cwiseAbs().maxCoeff()});
    residual.push_back(loads[b] - internal);
    extentOfAll = std::max(extentOfAll, extent(model_.bodies[b].mesh()));
  }
  double largestContact = 0;
  for (const Vector& p : iterate.contactForce)
    if (p.size() > 0) largestContact = std::max(largestContact, p.cwiseAbs().maxCoeff());
  for (size_t k = 0; k < model_.interfaces.size(); ++k) {
    const ContactInterface& interface = model_.interfaces[k];
    const int b1 = interface.pair().nonmortar.body;
    const int b2 = interface.pair().mortar.body;
    const Vector& p = iterate.contactForce[k];
    interface.subtractForces(p, residual[b1], residual[b2]);
    const auto displacement = [&](int b) {
      return Vector(state0.bodies[b].displacement + (iterate.bodies[b].increment + iterate.bodies[b].small));
    };
    const Vector g = interface.gap(displacement(b1), displacement(b2)) / extentOfAll;
    for (Eigen::Index i = 0; i < g.size(); ++i) {
      if (iterate.active[k][i] != 0) result.gapOnActive = std::max(result.gapOnActive, std::abs(g[i]));
      if (largestContact == 0) continue;
      result.sign = std::max({result.sign, -p[i] / largestContact, 0.0});
      result.complementarity = std::max(result.complementarity, std::abs(p[i] / largestContact * g[i]));
    }
  }
  if (force > 0)
    for (size_t b = 0; b < model_.bodies.size(); ++b)
      for (int dof = 0; dof < model_.bodies[b].dofs(); ++dof)
        if (model_.bodies[b].equations()[dof] >= 0)
          result.forceBalance = std::max(result.forceBalance, std::abs(residual[b][dof]) / force);
  return result;
}

StepOutcome StepSolver::newton(const State& state0, const StepData& step, const NewtonLimits& limits,
                               Iterate& iterate) {
  // Beyond this many yield stresses an iterate does not come back.
  constexpr double hopeless = 1e3;
  StepOutcome outcome;
  prescribe(state0, step.time, iterate);
  std::vector<Vector> loads;
  for (const Body& body : model_.bodies) loads.push_back(body.load(step.time));
  for (int iteration = 0;; ++iteration) {
    const double residual = linearise(state0, step, iterate, limits.anticipate);
    if (iteration > 0 && residual <= limits.tolerance) {
      outcome.certificate = certify(state0, loads, iterate, residual);
      if (outcome.certificate.forceBalance <= std::max(balanceTolerance, limits.tolerance * 1e-2)) {
        outcome.converged = true;
        return outcome;
      }
    }
    if (iteration == limits.iterations || !std::isfinite(residual) ||
        (iteration >= 2 && residual > hopeless)) {
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

// The step is solved with the viscosity raised so far that the bodies are almost elastic, then lowered by
// half decades, each stage begun from the last and solved roughly. Where a stage fails, the path goes back by
// two and is followed more closely.
StepOutcome StepSolver::continuation(const State& state0, const StepData& step, int maxIterations,
                                     Iterate& solution) {
  constexpr double firstStiffness = 0.3;
  constexpr double decades = 0.5;
  constexpr double closer = 1.5;
  constexpr double finestPace = 0.02;
  constexpr int stageIterations = 4;
  constexpr double finestTolerance = 1e-8;
  constexpr int lastIterations = 20;
  constexpr int stagesBack = 2;

  struct Stage {
    double decadesLeft = 0;
    Iterate iterate;
  };
  double stiffness = 0;
  for (const Body& body : model_.bodies)
    stiffness = std::max(stiffness, body.material().stiffness(step.weight));
  double pace = decades;
  double tolerance = 0.3;
  std::deque<Stage> path{{std::log10(stiffness / firstStiffness) + pace, start(state0)}};
  StepOutcome total;
  while (total.iterations < maxIterations) {
    Stage stage = path.back();
    stage.decadesLeft = std::max(0.0, stage.decadesLeft - pace);
    const bool last = stage.decadesLeft == 0;
    StepData eased = step;
    eased.weight = step.weight * std::pow(10, -stage.decadesLeft);
    const int iterations =
        std::min(last ? lastIterations : stageIterations, maxIterations - total.iterations);
    StepOutcome outcome =
        newton(state0, eased, {iterations, last ? options_.tolerance : tolerance, true}, stage.iterate);
    outcome.iterations += total.iterations;
    outcome.factorisations += total.factorisations;
    total = std::move(outcome);
    if (total.converged) {
      path.push_back(std::move(stage));
      if (last) break;
      if (path.size() > 2 * stagesBack + 1) path.erase(path.begin() + 1);
      continue;
    }
    tolerance = std::max(finestTolerance, tolerance / 10);
    pace = std::max(finestPace, pace / closer);
    for (int i = 0; i < stagesBack && path.size() > 1; ++i) path.pop_back();
  }
  solution = std::move(path.back().iterate);
  return total;
}

StepOutcome StepSolver::solve(const State& state0, const StepData& step, Iterate& guess) {
  constexpr int plainIterations = 7;
  StepOutcome plain = newton(state0, step, {plainIterations, options_.tolerance, false}, guess);
  if (plain.converged || plain.unheld) return plain;
  StepOutcome total = continuation(state0, step, options_.maxIterations - plain.iterations, guess);
  total.rung = "continuation";
  total.iterations += plain.iterations;
  total.factorisations += plain.factorisations;
  return total;
}

}  // namespace mortier
