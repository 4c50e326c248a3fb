// One time step: mixed Newton. Displacement increment and stress are both unknowns, so a triangle needs no
// local solve:
//
//   E^-1 (s - s0) + weight G(s) = B du - shift    in every triangle          (material)
//   sum |T| B' s + C' p = F(t1)                   at every free dof          (equilibrium)
//   g = C (u0 + du) - g0 <= 0, p >= 0, p g = 0    at every nonmortar node    (contact)
//
// Linearised at s (material/material.h), (material) gives s = predictor + H^-1 B d; what is left is
//   K d + C' p = F - sum |T| B' predictor,  K = sum |T| B' H^-1 B,
// with (contact) kept as it is: each body is condensed to its contact dofs, and the complementarity problem
// is solved there.
#pragma once

#include <array>
#include <cmath>
#include <functional>
#include <memory>
#include <vector>

#include "solver/body_system.h"
#include "solver/complementarity.h"
#include "solver/model.h"
#include "solver/state.h"

namespace mortier {

/// Per interface and nonmortar node, whether it is held closed.
using ActiveSets = std::vector<std::vector<char>>;

/// The sets with which a step from `state0` begins: where there was a force, or everywhere if there was none.
ActiveSets startingSets(const State& state0);

/// The unknowns of a step.
struct Iterate {
  std::vector<BodyIterate> bodies;
  std::vector<Vector> contactForce;  ///< p per interface
  ActiveSets active;
  double wrongForce = 0;  ///< the largest negative p of the last linear solve, before it was set to 0 [N/m]
};

/// g = C (u0 + du) - g0 per interface: the gap of the state and what the increments add.
std::vector<Vector> gaps(const Model& model, const State& state0, const Iterate& iterate);
/// Those of a solution: 0 where it is active, whatever rounding left there.
std::vector<Vector> solvedGaps(const Model& model, const State& state0, const Iterate& solution);

/// What is asked of a step.
struct StepData {
  double time = 0;            ///< t1: loads and prescribed displacements are taken here [s]
  double weight = 0;          ///< time step times the scheme's diagonal coefficient [s]
  std::vector<Matrix> shift;  ///< per body, components x points; empty for none
  bool settled = false;       ///< the start of the step is the solution of the one before
};

struct StepOutcome {
  bool converged = false;
  bool unheld = false;  ///< contact cannot balance the load: `reason` names the motion
  std::string reason;
  std::string rung = "newton";
  int iterations = 0;
  int factorisations = 0;
  Certificate certificate;
};

/// What a body answers to an error of its strain.
struct Response {
  Vector displacement;  ///< by dofs [m]
  Matrix stress;        ///< components x points [Pa]
};

/// How much is done before a step is given up.
enum class Effort {
  little,  ///< Newton's method alone: for a step that is likely to be too long
  usual,   ///< for a step that may as well be cut
  all      ///< also the methods that take thousands of linear solves
};

class StepSolver {
 public:
  /// \throws UnheldBodyError when neither supports nor contact hold a body.
  StepSolver(const Model& model, const SolverOptions& options);

  /// Nothing moved yet, contact forces and active set as in `state0`.
  [[nodiscard]] Iterate start(const State& state0) const;

  /// Solves from `guess`, falling back to a start from `state0`; the solution is left in `guess`.
  StepOutcome solve(const State& state0, const StepData& step, Iterate& guess, Effort effort = Effort::usual);

  /// With the tangent and the factors of the last solve, its active contacts kept closed and the others open:
  ///   s = H^-1 (B d - error),   sum |T| B' s + C_A' p = 0,   C_A d = 0.
  /// \param error  per body, a strain added in every triangle (components x points).
  [[nodiscard]] std::vector<Response> respond(const std::vector<Matrix>& error, const ActiveSets& active);

  /// The residuals of an iterate under nodal forces per body; the law as it was linearised last.
  [[nodiscard]] Certificate certify(const State& state0, const std::vector<Vector>& loads,
                                    const Iterate& iterate, double materialResidual) const;

  /// The rigid motion, in words, that no closed contact of a solution of a step holds, though no load drives it: the
  /// bodies could be anywhere along it. Empty where there is none, or only of bodies that nothing has moved so far.
  [[nodiscard]] std::string looseMotion(const State& state0, const Iterate& solution) const;

  /// Whether there are bodies that contact alone holds.
  [[nodiscard]] bool contactHolds() const { return contact_.G.cols() > 0; }

  /// What was met among the contact conditions so far.
  [[nodiscard]] const SpecialConditions& special() const { return special_; }

  /// What of the solver itself a run must know to go on from here as if it had not stopped.
  [[nodiscard]] SolverMemory memory() const;
  void resume(const SolverMemory& memory);

 private:
  friend class ViscosityPath;

  void requireHeld();
  void forEachBody(const Threads::Work& work) { threads_->forEach(static_cast<int>(systems_.size()), work); }
  /// Force balance asked of a converged step; far above rounding, far below what any result shows.
  static constexpr double balanceTolerance = 1e-11;

  [[nodiscard]] int rows() const { return firstRow_.back(); }
  [[nodiscard]] std::vector<Vector> displacements(const State& state0, const Iterate& iterate) const;
  [[nodiscard]] std::string describeRigid(const Vector& z) const;
  void strain(const StepData& step, int body, BodyIterate& iterate) const;
  double linearise(const State& state0, const StepData& step, Iterate& iterate, bool anticipate);
  bool factorise(StepOutcome& outcome);
  /// The contact problem of a linear solve: slack g0 - C u, forces p0, balance r, active set.
  using ContactSolve =
      std::function<ContactSolution(const Vector&, const Vector&, const Vector&, const std::vector<char>&)>;
  void solveLinearised(const State& state0, const std::vector<Vector>& loads,
                       const ContactSolve& contactSolve, Iterate& iterate, StepOutcome& outcome);
  /// By principal pivoting.
  void solveLinearised(const State& state0, const std::vector<Vector>& loads, Iterate& iterate,
                       StepOutcome& outcome);
  struct NewtonLimits {
    int iterations = 0;
    double tolerance = 0;
    bool anticipate = false;    ///< material/material.h
    bool elasticFirst = false;  ///< the first iteration takes the bodies as elastic
    bool turning =
        false;  ///< given up at once where a body that flowed is thrown far off, as where it unloads
  };
  /// Nodal forces of all bodies at a time; good until another time is asked for.
  const std::vector<Vector>& loadsAt(double time);
  bool sameData(double time, double other);
  [[nodiscard]] bool flows(const State& state) const;
  StepOutcome rest(const State& state0, const StepData& step, Iterate& solution);
  StepOutcome newton(const State& state0, const StepData& step, const NewtonLimits& limits, Iterate& iterate);
  double regularise(const State& state0, const StepData& step, Iterate& iterate);
  StepOutcome penaltyDuality(const State& state0, const StepData& step, Iterate& iterate);
  StepOutcome interiorPoint(const State& state0, const StepData& step, int maxIterations, Iterate& solution);
  StepOutcome continuation(const State& state0, const StepData& step, int maxIterations, Iterate& solution);
  StepOutcome damped(const State& state0, const StepData& step, int maxIterations, Iterate& solution);
  /// 1 or -1, the sign of the determinant of the last linearised step, these contacts closed.
  [[nodiscard]] int determinantSign(const ActiveSets& active) const;
  void prescribe(const State& state0, double time, Iterate& iterate) const;
  [[nodiscard]] std::vector<char> joined(const ActiveSets& active) const;

  const Model& model_;
  SolverOptions options_;
  std::unique_ptr<Threads> threads_;
  std::vector<int>
      firstRow_;  ///< of each interface among all contact conditions, and their number at the end
  std::vector<BodySystem> systems_;
  std::vector<int> firstMotion_;  ///< of each body among all rigid motions, and their number at the end
  ContactProblem contact_;
  SpecialConditions special_;
  struct Loads {
    double time = NAN;
    std::vector<Vector> forces;  ///< per body
  };
  std::array<Loads, 2> recentLoads_;  ///< the later used one first
  bool uniqueSolutions_ = true;       ///< every tangent symmetric: a step minimises a convex energy
};

}  // namespace mortier
