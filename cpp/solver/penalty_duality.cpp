// The penalty-duality method of Bermudez and Moreno (1981), which the note uses (as Burguera and Viano 1995):
// a constant matrix, factorised once, and multipliers that are updated by Yosida regularisations of the law
// and of the contact condition. Per iteration, from (du, s, p) in equilibrium:
//
//   t  with  E^-1 (t - s0) + weight G(t) = B du + D^-1 (s - t)     in every triangle   (material)
//   q  =     [p + omega g]_+,   g = C (u0 + du) - g0               at every node       (contact)
//
//   equilibrium with the stress s + 2 a (t - s) + D B d and the forces p + 2 a (q - p) + omega C d
//
// gives the next du, s and p. It converges linearly for every D > 0, omega > 0 and 0 < a < 1 where the law is
// monotone (Lions and Mercier 1979), the faster the nearer D^-1 is to the slope of the law and omega to that
// of the bodies:
//   D^-1  = E^-1 + penalty weight/(2 lambda), penalty the geometric mean of the slopes of flow,
//   omega = 1/sqrt(least times largest eigenvalue of the contact compliance W),
// which have the units that they need. Where convergence is slow the penalties are chosen again for the
// stress reached, ever more rarely, so that they become constant.
#include <algorithm>
#include <cmath>
#include <numeric>
#include <optional>
#include <utility>

#include "base/dense_templates.h"
#include "base/digits.h"
#include "base/formatted.h"
#include "base/worst.h"
#include "solver/friction_sets.h"
#include "solver/methods.h"

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

/// The bodies' answer to the multipliers. With the rigid motions z = zeta/omega and the jump a = C d that the
/// forces left over make at dp = 0:
///   (I + omega W) dp - G zeta = target + omega a,   G' dp = balance
/// or, over omega, the equations of all conditions held, each with the compliance 1/omega of its own.
class MultiplierSystem {
 public:
  explicit MultiplierSystem(const ContactProblem& contact) : rows_(contact.W.rows()) {
    if (rows_ == 0) return;
    constexpr double negligible = 1e-10;
    const Matrix W = 0.5 * (contact.W + contact.W.transpose());
    const Vector w = Eigen::SelfAdjointEigenSolver<Matrix>(W, Eigen::EigenvaluesOnly).eigenvalues();
    const double largest = w[rows_ - 1];
    omega_ = 1 / std::sqrt(std::max(w[0], negligible * largest) * largest);
    HeldConditions all{std::vector<Eigen::Index>(rows_)};
    std::iota(all.rows.begin(), all.rows.end(), 0);
    equations_.emplace(contact, std::move(all), 1 / omega_, 0);
  }

  [[nodiscard]] double omega() const { return omega_; }

  [[nodiscard]] ContactSolution solve(const Vector& target, const Vector& jump, const Vector& balance) const {
    ContactSolution solution;
    solution.outcome = ContactSolution::Outcome::solved;
    solution.active.assign(rows_, 1);
    solution.change = target / omega_ + jump;
    solution.rigid = balance;
    if (equations_) equations_->solve(solution.change, solution.rigid);
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
  std::optional<HeldSystem> equations_;
};

}  // namespace

StepOutcome penaltyDuality(StepSystem& system, const Step& step, Iterate& iterate) {
  const Model& model = system.model();
  const SolverOptions& options = system.options();
  StepOutcome outcome;
  outcome.method = SolutionMethod::penaltyDuality;
  prescribe(model, step, iterate);
  double largestLoad = 0;
  for (const Vector& load : step.loads) largestLoad = std::max(largestLoad, load.cwiseAbs().maxCoeff());
  std::vector<Vector> penalty(model.bodies.size());
  const StepSystem::LawOf regularised = [&](int b) -> BodyLaw {
    return {[&, b](const BodyIterate& body, Linearisation& result, int begin, int end) {
      return model.bodies[b].material().regularise(
          {step.data.weight, step.state0.bodies[b].stress, body.strain, false, step.strain0(b)}, body.stress,
          penalty[b], 2 * relaxation, result, begin, end);
    }};
  };
  Restarts restarts;
  std::optional<MultiplierSystem> multipliers;
  double change = 0;         // of stresses
  double contactChange = 0;  // of contact forces, over the largest force
  for (;; ++outcome.iterations) {
    const bool choose = !multipliers || restarts.due(outcome.iterations, std::max(change, contactChange));
    for (size_t b = 0; b < penalty.size() && choose; ++b)
      model.bodies[b].material().choosePenalty(iterate.bodies[b].stress, penalty[b]);
    StepSystem::Linearised linearised = system.linearise(step, iterate, regularised);
    change = linearised.residual();
    const std::optional<StepSystem::Factorised> factorised =
        choose ? linearised.factorise(outcome) : linearised.keepFactors();
    if (!factorised) return outcome;
    if (choose) multipliers.emplace(factorised->contact());

    const Vector g = system.joined(gaps(model, step.gap0(), iterate));
    const Vector p = system.joined(iterate.contactForce);
    const Vector q = (p + multipliers->omega() * g).cwiseMax(0);
    const double scale = q.size() > 0 ? std::max(largestLoad, q.maxCoeff()) : 0;
    contactChange = scale > 0 ? (q - p).cwiseAbs().maxCoeff() / scale : 0;

    if (outcome.iterations > 0 && change <= options.tolerance && contactChange <= contactTolerance) {
      Iterate solution = iterate;
      solution.contactForce = system.parted(q);
      for (size_t k = 0; k < solution.active.size(); ++k)
        for (size_t i = 0; i < solution.active[k].size(); ++i)
          solution.active[k][i] = solution.contactForce[k][static_cast<Eigen::Index>(i)] > 0 ? 1 : 0;
      solution.largestTension = p.size() > 0 ? std::max(0.0, -p.minCoeff()) : 0;
      const double residual = system.linearise(step, solution, step.data.weight, false).residual();
      const Certificate certificate = system.certify(step, solution, residual);
      if (residual <= options.tolerance && certificate.forceBalance <= balanceTolerance) {
        iterate = std::move(solution);
        outcome.converge(certificate);
        return outcome;
      }
      system.linearise(step, iterate, regularised);
    }
    if (outcome.iterations == options.maxIterations || !std::isfinite(change + contactChange)) {
      outcome.fail(Reason::unconverged,
                   "the penalty-duality method did not converge in " +
                       counted(outcome.iterations, "iteration") +
                       formatted(": stresses change by %g yield stresses, contact forces "
                                 "by %g; solver.method = \"newton\" solves more",
                                 change, contactChange));
      return outcome;
    }

    // The forces that the new load requires are found first: a passing one beyond yield would be hard to
    // undo.
    StepSystem::Condensed condensed = factorised->condense(step, iterate);
    const Vector& slack = condensed.slack;
    ContactSolution contact;
    if (outcome.iterations > 0) {
      contact = multipliers->solve(2 * relaxation * (q - p), -(slack + g), condensed.balance);
    } else {
      if (condensed.balance.size() > 0)
        contact = solveContact(factorised->contact(), slack, p, condensed.balance, condensed.sets.closed);
      if (contact.outcome != ContactSolution::Outcome::unbalanced) {
        contact = multipliers->iterate(factorised->contact(), g, slack, p, condensed.balance,
                                       options.maxIterations - 1);
        outcome.iterations += contact.pivots;
      }
    }
    if (!std::move(condensed).expand(contact, iterate, outcome)) return outcome;
    iterate.contactForce = system.parted(p + contact.change);  // multipliers may pull on the way
  }
}

}  // namespace mortier
