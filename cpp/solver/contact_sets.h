// A contact problem (complementarity.h) solved for a sequence of active sets: the interface that principal
// pivoting needs, independent of how the equations of a set are solved. A proximal term on the rigid motions
// enforces their balance,
//   s = s0 + W dp - G z,   p = p0 + dp,   G' dp + weight (z - z0) = r,   s_A = 0,   p = 0 off A.
// Solves are repeated about the last solution until such a term carries nothing (Rockafellar 1976).
#pragma once

#include <limits>
#include <vector>

#include "solver/complementarity.h"

namespace mortier {

/// The weight of a proximal term over that in the repetition before, where it is reduced [-].
constexpr double softer = 1e-2;
/// Down to which weight, over the stiffness that all nodes together give to rigid motions [-].
constexpr double weakestProximal = 1e-13;
/// The remainder of the balance of rigid motions by rounding, over the forces in it [-].
constexpr double balanceRounding = 1e-14;

inline double ratio(double part, double whole) {
  return part == 0 ? 0 : part / whole;
}

/// Calls solve(), which solves about its last solution and returns what the term still carries [-], until
/// that is `rounding`. Where more than three repetitions are needed the term is too strong: soften().
template <class Solve, class Soften = void (*)()>
void repeatProximal(
    int most, double rounding, const Solve& solve, const Soften& soften = [] {}) {
  constexpr double slow = 1e-12;  // three repetitions leave no more
  for (int repetition = 0; repetition < most; ++repetition) {
    const double carried = solve();
    if (carried <= rounding) return;
    if (repetition > 1 && carried > slow) soften();
  }
}

/// The stiffness of the proximal term on rigid motions: where a gap is open, the load can close it.
/// \param open  the widest gap
double proximalStiffness(double stiffness, double load, double open);

class ContactSets {
 public:
  ContactSets(const ContactSets&) = delete;
  ContactSets& operator=(const ContactSets&) = delete;
  virtual ~ContactSets() = default;

  /// Sets z0, and how many solves are allowed until the next call.
  void setProximalPoint(const Vector& z0);
  /// Weakens the proximal term.
  void soften();

  /// dp and z on solution.active. \returns false where that is redundant.
  bool solveOn(ContactSolution& solution);
  /// The same with factors of the set itself, if those in use are not.
  virtual bool refactor(const std::vector<char>& active) = 0;
  [[nodiscard]] virtual bool fresh() const = 0;

  /// The solution on the last set, and the conditions that it violates.
  struct Violations {
    Vector slack;                  ///< 0 on the set
    Vector force;                  ///< p, not below 0
    std::vector<int> tension;      ///< active, p < 0
    std::vector<int> penetration;  ///< inactive, s < 0
  };
  /// Violations beyond rounding; slacks count as the forces that would close them.
  [[nodiscard]] Violations violationsOf(const ContactSolution& solution) const;
  /// Derivatives of all forces and slacks by the force of one inactive condition, the active ones kept closed
  /// [-, s/p].
  struct Growth {
    Vector force, slack;
  };
  /// \returns false where the set is redundant.
  bool grow(int condition, ContactSolution& solution, Growth& growth);

  /// Values below this part of the largest are rounding.
  static constexpr double rounding = 64 * std::numeric_limits<double>::epsilon();

  [[nodiscard]] const ContactProblem& problem() const { return problem_; }
  /// Compliance of each condition, by which slacks are taken for forces.
  [[nodiscard]] const Vector& diagonal() const { return diagonal_; }
  [[nodiscard]] const Vector& p0() const { return p0_; }
  /// Slack of the set that was solved on last, of closed conditions the rounding.
  [[nodiscard]] const Vector& slack() const { return open_; }
  [[nodiscard]] bool idle(int condition) const { return idle_[condition] != 0; }
  /// Whether a matrix that was to be solved with is singular but for rounding.
  [[nodiscard]] bool redundant() const { return redundant_; }
  /// Whether all work or all solves that are allowed were done.
  [[nodiscard]] virtual bool capped() const { return pivotsLeft_ <= 0; }
  /// The part of the balance that the proximal term carries, over the contact forces and `scales` [-].
  [[nodiscard]] double imbalance(const ContactSolution& solution, const Vector& scales) const;
  /// Per condition, the contact force of the step before, or that of the rounding of gaps where it is larger.
  [[nodiscard]] Vector forceScales(const ContactSolution& solution) const;
  /// Whether the load drives the bodies along a rigid motion that no contact resists.
  [[nodiscard]] bool isUnbounded(const ContactSolution& solution) const;
  /// The rigid motions of a solution, without what is none.
  [[nodiscard]] virtual Vector rigid(const ContactSolution& solution) const { return solution.rigid; }

 protected:
  /// \param idle  conditions that stay inactive. All that is given by reference must outlive this.
  ContactSets(const ContactProblem& problem, const std::vector<char>& idle, Vector diagonal, Vector slack,
              const Vector& p0, const Vector& balance);

  /// Takes the equations of a set. \returns false where it is redundant.
  virtual bool take(const std::vector<char>& active) = 0;
  /// solveOn() and grow() on the set that was taken last.
  virtual void solveTaken(ContactSolution& solution) = 0;
  virtual void growTaken(int condition, Growth& growth) = 0;

  /// What is rounding in forces, and in slacks as forces.
  struct Noise {
    double force = 0;
    Vector depth;
  };
  [[nodiscard]] virtual Noise noise(const ContactSolution& solution) const = 0;
  /// Largest slack of closed conditions, as a force.
  [[nodiscard]] double residual(const ContactSolution& solution) const;
  /// The size of forces, those there are and those that gaps of the closed conditions make.
  [[nodiscard]] double sizeOf(const ContactSolution& solution) const;

  const ContactProblem& problem_;
  const std::vector<char>& idle_;
  Vector diagonal_;
  Vector slack_;
  const Vector& p0_;
  const Vector& balance_;
  Vector open_;  ///< slack of the set that was solved on last
  Vector z0_;
  double weight_ = 0;   ///< of the proximal term
  double weakest_ = 0;  ///< to which it is reduced at most
  bool redundant_ = false;

 private:
  int pivotsLeft_ = 0;  ///< sets of a few conditions cost next to no work
};

/// Rigid motions that the closed conditions of a set resist, and those that they do not: by columns.
struct RigidMotions {
  Matrix held, free;
};
RigidMotions rigidMotionsOn(const std::vector<char>& active, const Matrix& G);

/// Principal pivoting (pivoting.cpp), repeated until the proximal term no longer acts.
/// \param active  the set to begin with. \throws Interrupted
ContactSolution solveBalanced(ContactSets& contact, const std::vector<char>& active);

/// Takes from the slack the rigid motions that close the gaps of `active` (of all conditions, where it is
/// empty) in the least squares. Beside stiff bodies these gaps stand for so large forces that those of the
/// load would be lost in their rounding. \returns the motions
Vector moveRigidBodiesIntoContact(const Matrix& G, const std::vector<char>& active, Vector& slack);

/// Conditions that no free motion can change: both sides are held there.
std::vector<char> idleConditions(const Vector& diagonal);

}  // namespace mortier
