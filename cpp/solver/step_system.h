// The linearised step. Displacement increment and stress are both unknowns, so a triangle needs no local
// solve:
//
//   E^-1 (s - s0) + weight G(s) = B du - explicitStrain    in every triangle          (material)
//   sum |T| B' s + C' p = F(t1)                   at every free dof          (equilibrium)
//   g = C (u0 + du) - g0 <= 0, p >= 0, p g = 0    at every nonmortar node    (contact)
//
// with T' t beside C' p and the law of t and the slip T du (friction.h) where there is friction, and C' l of
// ties, C du = 0, which are eliminated first (tie_elimination.h).
//
// Linearised at s (material/material.h), (material) gives s = predictor + H^-1 B d; there remains
//   K d + C' p = F - sum |T| B' predictor,  K = sum |T| B' H^-1 B,
// with (contact) kept as it is: each body is condensed to its contact dofs, and the complementarity problem
// is solved there. A linear solve goes from one type to the next, and only so:
//
//   StepSystem -linearise-> Linearised -factorise-> Factorised -solve-> iterate
//
// where solve() is condense -> Condensed -solveContact, expand.
//
// Each is good until the next linearise().
#pragma once

#include <array>
#include <cmath>
#include <functional>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "base/parallel.h"
#include "solver/complementarity.h"
#include "solver/condensed_body.h"
#include "solver/friction.h"
#include "solver/iterate.h"
#include "solver/outcome.h"
#include "solver/sparse_contact.h"
#include "solver/tie_elimination.h"

namespace mortier {

/// Force balance asked of a converged step; far above rounding, far below what any result shows.
constexpr double balanceTolerance = 1e-11;
/// Every residual of a solution is below that (Certificate); most are 1e-10 and less.
constexpr double residualTolerance = 1e-8;

/// What bodies of a linear problem respond to.
struct LinearLoad {
  std::vector<Matrix> strain;       ///< per body, added in every triangle (components x points)
  std::vector<Vector> slip = {};    ///< per interface, by which the nodes that stick slip [m]; empty for none
  std::vector<Vector> force = {};   ///< per body (dofs) [N/m]; empty for none
  std::vector<Vector> across = {};  ///< per interface, C d of closed conditions [m]; empty for none
  bool adjoint = false;             ///< whether contact with friction is that of the transposed problem
};

/// How a body responds to them.
struct Response {
  Vector displacement;  ///< by dofs [m]
  Matrix stress;        ///< components x points [Pa]
};

/// The sets of all interfaces as one.
FrictionSets joinedSets(const Iterate& iterate);

class ClosedContact;

class StepSystem {
  struct Key {
    explicit Key() = default;
  };

 public:
  /// \throws UnheldBodyError when neither supports nor contact hold a body.
  StepSystem(const Model& model, const SolverOptions& options);

  [[nodiscard]] const Model& model() const { return model_; }
  [[nodiscard]] const SolverOptions& options() const { return options_; }

  /// Takes the rows of interfaces that have followed the bodies; what belongs to bodies alone is kept.
  void updateConstraints();

  /// The data of a step from a state; valid until loads at two other times have been asked for.
  [[nodiscard]] Step step(const State& state0, const StepData& data);
  /// Nodal forces of all bodies at a time.
  const std::vector<Vector>& loadsAt(double time);

  /// The law that a body is linearised with.
  using LawOf = std::function<BodyLaw(int body)>;
  class Linearised;
  Linearised linearise(const Step& step, Iterate& iterate, const LawOf& lawOf);
  /// The law of the material, with this weight [s].
  [[nodiscard]] BodyLaw law(const Step& step, int body, double weight, bool anticipate) const;
  Linearised linearise(const Step& step, Iterate& iterate, double weight, bool anticipate);

  class Factorised;
  class Condensed;

  /// The residuals of an iterate, with the law as it was linearised last.
  /// \param repeated  linear solves do not reduce the residuals: where nothing loads the bodies and all
  ///     forces are rounding, residuals are none
  [[nodiscard]] Certificate certify(const Step& step, const Iterate& iterate, double materialResidual,
                                    bool repeated = false) const;

  /// What the rounding of the last linear solve left of the gaps of closed conditions, each as the force that
  /// would close it by itself, over the largest contact force; 0 with friction [-].
  [[nodiscard]] double gapRoundoff(const Step& step, const Iterate& iterate) const;

  /// W_ii of all conditions, as linearised last; none before. [m^2/N]
  [[nodiscard]] Vector compliances() const;

  /// Where an iterate is further off the law than a converged step may be; none where it is so nowhere.
  std::optional<StuckPlace> worstPoint(const Step& step, Iterate& iterate, double weight);

  /// Factorised::respond with the last tangent, factorised anew where points began or ceased to flow since.
  std::vector<Response> respond(const std::vector<Matrix>& error, const Iterate& on,
                                const std::vector<Vector>& slip = {});
  /// Friction forces at the start of a step or, of nodes that begin to slip in it, where they do
  /// (slip_onset.cpp), per interface [N/m].
  std::vector<Vector> frictionAtSlip(const State& state0, const std::vector<Vector>& gap0,
                                     const Iterate& end);

  /// The rigid motion, in words, that no closed contact of a solution of a step holds, though no load drives
  /// it: the bodies could be anywhere along it. Empty where there is none, or only of bodies that nothing has
  /// moved so far.
  [[nodiscard]] std::string looseMotion(const State& state0, const Iterate& solution) const;
  /// Whether there are bodies, tied or not, that contact alone holds.
  [[nodiscard]] bool contactHolds() const { return contact_.G.cols() > 0; }
  /// Whether contact is solved without dense matrices over its conditions.
  [[nodiscard]] bool sparse() const { return sparse_ != nullptr; }
  /// Whether any interface has friction.
  [[nodiscard]] bool hasFriction() const { return !contact_.along.node.empty(); }
  /// Whether linear solves can be completed (Factorised::complete) and other factors cost much more.
  [[nodiscard]] bool completes() const;
  /// Whether every tangent is symmetric: a step minimises a convex energy.
  [[nodiscard]] bool uniqueSolutions() const { return uniqueSolutions_; }
  /// The special contact conditions that were found so far.
  [[nodiscard]] const SpecialConditions& special() const { return special_; }

  /// What was found of the solutions of the contact problems with friction since this was called last; those
  /// listed are of the last one.
  StepSolutions takeSolutions();

  /// One vector of all conditions from those of the interfaces, and the reverse.
  /// \param along  the line, of interfaces with friction: they come after all others.
  /// The last tangent's, factorised anew where points began or ceased to flow since.
  Factorised currentFactors();
  [[nodiscard]] static Vector joined(const std::vector<Vector>& across,
                                     const std::vector<Vector>& along = {});
  [[nodiscard]] std::vector<Vector> parted(const Vector& all) const;

  [[nodiscard]] Threads& threads() const { return threads_; }
  void forEachBody(const Threads::Work& work) { threads_.forEach(static_cast<int>(bodies_.size()), work); }
  /// Whether any body has factors that leave more than rounding, which linear solves with them take away.
  [[nodiscard]] bool inSinglePrecision() const;
  /// Uses double precision from now on; where that was in use, CHOLMOD or UMFPACK.
  void useNextEngine();
  /// The state of the solver itself that a run needs to resume as if it had not stopped.
  [[nodiscard]] SolverMemory memory() const;
  void resume(const SolverMemory& memory);

 private:
  void requireHeld();
  void joinMotions();
  /// Takes the contact forces, across the line and along it, from the forces on the bodies (dofs).
  void subtractContact(const std::vector<Vector>& p, const std::vector<Vector>& t,
                       std::vector<Vector>& force) const;
  /// The same of the forces of ties.
  void subtractTies(const std::vector<Vector>& l, std::vector<Vector>& force) const;
  /// One vector by ties from that of all constraints.
  [[nodiscard]] std::vector<Vector> tiesOf(const Vector& all) const;
  /// By the equations of all bodies.
  [[nodiscard]] Vector gathered(const std::vector<Vector>& nodal) const;
  [[nodiscard]] std::vector<Vector> spread(const Vector& x, const Vector& rigid) const;
  /// The motion under these forces with the contacts that are closed in `on` moved by `slack`.
  [[nodiscard]] ContactSolution holdClosedSparse(const std::vector<Vector>& force, const Vector& slack,
                                                 const Iterate& on) const;
  /// The same of dense contact, with all constraints.
  [[nodiscard]] ContactSolution holdClosed(const ClosedContact& closed,
                                           const TieElimination::Whole& whole) const;
  [[nodiscard]] std::string describeRigid(const Vector& z) const;
  /// Conditions along contact that resist no motion: their nodes slip, or nothing presses.
  struct SlidingConditions {
    std::vector<int> conditions;
    std::vector<int> signs;  ///< of t; 0 where nothing presses
    Matrix G;                ///< of all conditions, in space along and across the directions of slip
  };
  [[nodiscard]] SlidingConditions slidingConditions(const Iterate& solution) const;
  [[nodiscard]] Vector motionOf(const Vector& z, size_t body) const {
    return z.segment(firstMotion_[body], firstMotion_[body + 1] - firstMotion_[body]);
  }
  [[nodiscard]] int rows() const { return firstRow_.back(); }
  /// Those across contact and those along it.
  [[nodiscard]] int conditions() const { return rows() + static_cast<int>(contact_.along.conditions()); }
  /// These and the rows of ties.
  [[nodiscard]] int constraints() const { return conditions() + static_cast<int>(ties_.ties()); }
  void findFriction();
  [[nodiscard]] ListedSolution listed(const FrictionSolution& solution) const;
  /// CondensedBody::condense and expand; take(body, displacement).
  std::vector<Vector> condenseBodies(const std::vector<Vector>& force);
  void expandBodies(const ContactSolution& contact, const std::function<void(int, const Vector&)>& take);

  const Model& model_;
  SolverOptions options_;
  mutable Threads threads_;  ///< no part of what the system is
  std::vector<int>
      firstRow_;  ///< of each interface among all contact conditions, and their number at the end
  std::vector<CondensedBody> bodies_;
  std::vector<int> firstMotion_{0};  ///< of each body among all rigid motions, and their number at the end
  ContactProblem contact_;           ///< its W is that of all conditions; none where contact is sparse
  TieElimination ties_;
  std::unique_ptr<SparseContact> sparse_;
  SpecialConditions special_;
  StepSolutions solutions_;
  struct Loads {
    double time = NAN;
    std::vector<Vector> forces;  ///< per body
  };
  std::array<Loads, 2> loads_;
  size_t latestLoads_ = 0;
  bool olderFactors_ = false;  ///< in use, not those of the last linearisation
  bool uniqueSolutions_ = true;
};

/// The law of a step linearised at an iterate.
class StepSystem::Linearised {
 public:
  Linearised(StepSystem& system, double residual, Key /*key*/) : system_(&system), residual_(residual) {}
  /// The material residual, scaled; NaN where any stress is NaN.
  [[nodiscard]] double residual() const { return residual_; }
  [[nodiscard]] const Linearisation& law(int body) const { return system_->bodies_[body].law(); }
  /// Empty where a tangent is singular; `outcome` then has the reason.
  [[nodiscard]] std::optional<Factorised> factorise(StepOutcome& outcome) const;
  /// Takes the factors of the linearisation before, which had the same tangent.
  /// \param older  it had another one: linear solves have to be completed
  [[nodiscard]] Factorised keepFactors(bool older = false) const;

 private:
  StepSystem* system_;
  double residual_;
};

class StepSystem::Factorised {
 public:
  Factorised(StepSystem& system, Key /*key*/) : system_(&system) {}
  /// The linear solve: condenses, solves the contact problem and moves the iterate to its solution.
  /// \returns false where there is none; `outcome` then has the reason.
  bool solve(const Step& step, Iterate& iterate, StepOutcome& outcome) const;
  /// What the factors, of another tangent or rounded, leave of the equilibrium of a linear solve, by
  /// conjugate gradients on the contacts that are closed.
  /// \param before  where the solve began  \param part  what may be left, over the solve, in energy
  /// \returns whether `most` iterations were enough
  bool complete(const Step& step, const Iterate& before, double part, int most, Iterate& iterate) const;
  /// Condenses the forces that are out of balance to the contact conditions.
  [[nodiscard]] Condensed condense(const Step& step, const Iterate& iterate) const;
  [[nodiscard]] const ContactProblem& contact() const { return system_->contact_; }
  /// With the contacts that are closed in `on` kept closed and the others open:
  ///   s = H^-1 (B d - strain),   sum |T| B' s + C_A' p = force,   C_A d = across;
  /// with friction t of sticking nodes is free, and that of slipping nodes +-mu p,
  /// or, of the adjoint problem, that of slipping nodes is 0, and C_A d +- mu T d = 0 there.
  [[nodiscard]] std::vector<Response> respond(const LinearLoad& to, const Iterate& on) const;

 private:
  StepSystem* system_;
};

/// The contact problem of a linear solve (complementarity.h).
class StepSystem::Condensed {
 public:
  Condensed(StepSystem& system, Key /*key*/) : system_(&system) {}
  [[nodiscard]] ContactSolution solveContact() const;
  /// The same with friction (friction.h).
  [[nodiscard]] ContactSolution solveFriction() const;
  /// Moves the iterate (displacement, stress, contact) to the solution of the linear solve.
  /// \returns false where there is none; `outcome` then has the reason.
  bool expand(const ContactSolution& contact, Iterate& iterate, StepOutcome& outcome) &&;

  Vector slack;                 ///< g0 - C u at dp = 0, then -T du
  Vector p0;                    ///< contact forces, then those of friction
  Vector balance;               ///< of the forces that only contact can carry
  TieElimination::Whole whole;  ///< slacks and balance with those of ties
  FrictionSets sets;            ///< to begin with
  std::vector<Vector> force;    ///< out of balance, per body (dofs), where contact is sparse

 private:
  StepSystem* system_;
};

}  // namespace mortier
