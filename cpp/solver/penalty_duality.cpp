// The penalty-duality method of Bermudez and Moreno (1981), which the note uses (as Burguera and Viano 1995): a
// constant matrix, factorised once, and multipliers that are updated by Yosida regularisations of the law and of the
// contact condition. Per iteration, from (du, s, p) in equilibrium:
//
//   t  with  E^-1 (t - s0) + weight G(t) = B du + D^-1 (s - t)     in every triangle   (material)
//   q  =     [p + omega g]_+,   g = C (u0 + du) - g0               at every node       (contact)
//
//   equilibrium with the stress s + 2 a (t - s) + D B d and the forces p + 2 a (q - p) + omega C d
//
// gives the next du, s and p. It converges linearly for every D > 0, omega > 0 and 0 < a < 1 where the law is monotone
// (Lions and Mercier 1979), the faster the nearer D^-1 is to the slope of the law and omega to that of the
// bodies:
//   D^-1  = E^-1 + penalty weight/(2 lambda), penalty the geometric mean of the slopes of the flow (choosePenalty),
//   omega = 1/sqrt(least times largest eigenvalue of the contact compliance W),
// which have the units that they need. Where convergence is slow the penalties are chosen again for the stress
// reached, ever more rarely, so that they become constant.
#include <Eigen/Eigenvalues>
#include <algorithm>
#include <cmath>
#include <optional>
#include <sstream>

#include "base/worst.h"
#include "solver/step.h"

namespace mortier {
namespace {

constexpr double relaxation = 0.75;  ///< a; towards 1 bodies that only contact holds come to rest slowly
constexpr double contactTolerance = 1e-12;

/// When to choose the penalties again: after spans that grow, where the change did not fall enough in one.
class Restarts {
 public:
  bool due(int iteration, double change) {
    constexpr double enough = 0.3;
    constexpr double growth = 1.2;
    if (iteration < next_) return false;
    span_ = std::ceil(growth * span_);
    next_ += static_cast<int>(span_);
    const bool slow = change > enough * before_;
    before_ = change;
    return slow;
  }

 private:
  double span_ = 10;
  int next_ = 10;
  double before_ = INFINITY;
};

/// The bodies' answer to the multipliers. With the rigid motions z = zeta/omega and the jump a = C d that the forces
/// left over make at dp = 0:
///   (I + omega W) dp - G zeta = target + omega a,   G' dp = balance
class MultiplierSystem {
 public:
  explicit MultiplierSystem(const ContactProblem& contact) : rows_(contact.W.rows()) {
    if (rows_ == 0) return;
    constexpr double negligible = 1e-10;
    const Vector w = Eigen::SelfAdjointEigenSolver<Matrix>(0.5 * (contact.W + contact.W.transpose()),
                                                           Eigen::EigenvaluesOnly)
                         .eigenvalues();
    const double largest = w[rows_ - 1];
    omega_ = 1 / std::sqrt(std::max(w[0], negligible * largest) * largest);
    const Eigen::Index motions = contact.G.cols();
    Matrix system = Matrix::Zero(rows_ + motions, rows_ + motions);
    system.topLeftCorner(rows_, rows_) = Matrix::Identity(rows_, rows_) + omega_ * contact.W;
    system.topRightCorner(rows_, motions) = -contact.G;
    system.bottomLeftCorner(motions, rows_) = contact.G.transpose();
    lu_.compute(system);
  }

  [[nodiscard]] double omega() const { return omega_; }

  [[nodiscard]] ContactSolution solve(const Vector& target, const Vector& jump, const Vector& balance) const {
    ContactSolution solution;
    solution.outcome = ContactSolution::Outcome::solved;
    solution.active.assign(rows_, 1);
    Vector right(rows_ + balance.size());
    right << target + omega_ * jump, balance;
    if (rows_ > 0) right = Vector(lu_.solve(right));
    solution.change = right.head(rows_);
    solution.rigid = right.tail(balance.size()) / omega_;
    return solution;
  }

  /// Iterates on the contact forces alone, the law as it is linearised; ends early where it must.
  /// \param gap  at which the multipliers begin; counted in `pivots`
  [[nodiscard]] ContactSolution iterate(const ContactProblem& contact, const Vector& gap, const Vector& slack,
                                        const Vector& p0, const Vector& balance, int limit) const {
    constexpr double converged = 1e-13;
    ContactSolution solution = solve(Vector::Zero(p0.size()), -slack - gap, balance);
    if (rows_ == 0) return solution;
    for (; solution.pivots < limit; ++solution.pivots) {
      const Vector p = p0 + solution.change;
      const Vector g = contact.G * solution.rigid - slack - contact.W * solution.change;
      const Vector q = (p + omega_ * g).cwiseMax(0);
      if ((q - p).cwiseAbs().maxCoeff() <= converged * q.maxCoeff()) break;
      const int pivots = solution.pivots;
      solution = solve(solution.change + 2 * relaxation * (q - p), -slack - g, balance);
      solution.pivots = pivots;
    }
    return solution;
  }

 private:
  Eigen::Index rows_;
  double omega_ = 1;
  Eigen::PartialPivLU<Matrix> lu_;
};

}  // namespace

/// \returns how far the stress is from the law, scaled; NaN when any stress is.
double StepSolver::regularise(const State& state0, const StepData& step, Iterate& iterate) {
  std::vector<double> change(systems_.size());
  forEachBody([&](int b) {
    BodyIterate& body = iterate.bodies[b];
    change[b] = systems_[b].regularise({step.weight, state0.bodies[b].stress, body.strain},
                                       step.shift.empty() ? nullptr : &step.shift[b], 2 * relaxation, body);
  });
  Worst worst;
  for (const double value : change) worst.add(value);
  return worst.value();
}

StepOutcome StepSolver::penaltyDuality(const State& state0, const StepData& step, Iterate& iterate) {
  StepOutcome outcome;
  outcome.rung = "penalty-duality";
  prescribe(state0, step.time, iterate);
  const std::vector<Vector>& loads = loadsAt(step.time);
  double largestLoad = 0;
  for (const Vector& load : loads) largestLoad = std::max(largestLoad, load.cwiseAbs().maxCoeff());
  Restarts restarts;
  std::optional<MultiplierSystem> system;
  double change = 0;         // of stresses
  double contactChange = 0;  // of contact forces, over the largest force
  for (;; ++outcome.iterations) {
    const bool choose = !system || restarts.due(outcome.iterations, std::max(change, contactChange));
    for (size_t b = 0; b < systems_.size() && choose; ++b)
      systems_[b].choosePenalty(iterate.bodies[b].stress);
    change = regularise(state0, step, iterate);
    if (choose) {
      if (!factorise(outcome)) return outcome;
      system.emplace(contact_);
    }

    const std::vector<Vector> gap = gaps(model_, state0, iterate);
    Vector g(rows());
    Vector p(rows());
    for (size_t k = 0; k < model_.interfaces.size(); ++k) {
      g.segment(firstRow_[k], gap[k].size()) = gap[k];
      p.segment(firstRow_[k], gap[k].size()) = iterate.contactForce[k];
    }
    const Vector q = (p + system->omega() * g).cwiseMax(0);
    const double scale = q.size() > 0 ? std::max(largestLoad, q.maxCoeff()) : 0;
    contactChange = scale > 0 ? (q - p).cwiseAbs().maxCoeff() / scale : 0;

    if (outcome.iterations > 0 && change <= options_.tolerance && contactChange <= contactTolerance) {
      Iterate solution = iterate;
      for (size_t k = 0; k < model_.interfaces.size(); ++k)
        for (int i = 0; i < model_.interfaces[k].rows(); ++i) {
          solution.contactForce[k][i] = q[firstRow_[k] + i];
          solution.active[k][i] = q[firstRow_[k] + i] > 0 ? 1 : 0;
        }
      solution.wrongForce = p.size() > 0 ? std::max(0.0, -p.minCoeff()) : 0;
      const double residual = linearise(state0, step, solution, false);
      outcome.certificate = certify(state0, loads, solution, residual);
      if (residual <= options_.tolerance && outcome.certificate.forceBalance <= balanceTolerance) {
        iterate = std::move(solution);
        outcome.converged = true;
        return outcome;
      }
      regularise(state0, step, iterate);
    }
    if (outcome.iterations == options_.maxIterations || !std::isfinite(change + contactChange)) {
      std::ostringstream reason;
      reason << "the penalty-duality method did not converge in " << outcome.iterations
             << " iterations: stresses change by " << change << " yield stresses, contact forces by "
             << contactChange << "; solver.method = \"newton\" solves more";
      outcome.reason = reason.str();
      return outcome;
    }

    // The forces that the new load asks for are found first: a passing one beyond yield would be hard to undo.
    const bool first = outcome.iterations == 0;
    const ContactSolve multipliers = [&](const Vector& slack, const Vector& p0, const Vector& balance,
                                         const std::vector<char>& active) {
      if (!first) return system->solve(2 * relaxation * (q - p), -(slack + g), balance);
      if (balance.size() > 0) {
        ContactSolution held = solveContact(contact_, slack, p0, balance, active);
        if (held.outcome == ContactSolution::Outcome::unbalanced) return held;
      }
      ContactSolution solution = system->iterate(contact_, g, slack, p0, balance, options_.maxIterations - 1);
      outcome.iterations += solution.pivots;
      return solution;
    };
    solveLinearised(state0, loads, multipliers, iterate, outcome);
    if (!outcome.reason.empty()) return outcome;
  }
}

}  // namespace mortier
