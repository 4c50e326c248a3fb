// A contact problem (complementarity.h) solved for a sequence of active sets: the interface that principal
// pivoting needs, independent of how the equations of a set are solved. A proximal term on the rigid motions
// enforces their balance,
//   s = s0 + W dp - G z,   p = p0 + dp,   G' dp + proximal (z - z0) = r,   s_A = 0,   p = 0 off A.
#pragma once

#include <limits>
#include <vector>

#include "solver/complementarity.h"

namespace mortier {

class ContactSets {
 public:
  ContactSets(const ContactSets&) = delete;
  ContactSets& operator=(const ContactSets&) = delete;
  virtual ~ContactSets() = default;

  /// Sets z0, and how many solves are allowed until the next call.
  virtual void centre(const Vector& z0) = 0;
  /// Weakens the proximal term: repetitions converge faster than at any fixed weight (Rockafellar 1976).
  virtual void soften() = 0;

  /// dp and z on solution.active. \returns false where that is redundant.
  virtual bool solveOn(ContactSolution& solution) = 0;
  /// The same with factors of the set itself, if those in use are not.
  virtual bool refactor(const std::vector<char>& active) = 0;
  [[nodiscard]] virtual bool fresh() const = 0;

  /// Of the set that was solved on last, and what is wrong with it.
  struct Signs {
    Vector slack;               ///< 0 on the set
    Vector force;               ///< p, not below 0
    std::vector<int> pulls;     ///< active, p < 0
    std::vector<int> overlaps;  ///< inactive, s < 0
  };
  /// Judged against rounding, slacks as the forces that would close them.
  [[nodiscard]] Signs signsOf(const ContactSolution& solution) const;
  /// By how much all forces and slacks grow with the force of one inactive condition, the active ones staying
  /// closed [-, s/p].
  struct Growth {
    Vector force, slack;
  };
  /// \returns false where the set is redundant.
  virtual bool grow(int condition, ContactSolution& solution, Growth& growth) = 0;

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
  [[nodiscard]] virtual bool capped() const = 0;
  /// What the proximal term still carries of the balance, against all forces in it, or those that are usual.
  [[nodiscard]] double imbalance(const ContactSolution& solution, const Vector& usual) const;
  /// Contact forces of the step before, and on closed conditions those that the rounding of gaps makes.
  [[nodiscard]] Vector usualForces(const ContactSolution& solution) const;
  /// Whether the load drives the bodies along a motion that opens contact or slides along it.
  [[nodiscard]] bool leaves(const ContactSolution& solution) const;
  /// The rigid motions of a solution, without what is none.
  [[nodiscard]] virtual Vector rigid(const ContactSolution& solution) const { return solution.rigid; }

 protected:
  /// \param idle  conditions that stay inactive. All that is given by reference must outlive this.
  ContactSets(const ContactProblem& problem, const std::vector<char>& idle, Vector diagonal, Vector slack,
              const Vector& p0, const Vector& balance);

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
  bool redundant_ = false;
};

/// Principal pivoting, repeated until the proximal term no longer acts. \param active  the set to begin with.
ContactSolution solveBalanced(ContactSets& contact, const std::vector<char>& active);

/// The rigid motions that take away the gaps and overlaps of the conditions to begin with (of all, where
/// there are none) as far as they can, first: beside stiff bodies these are so many forces that those of the
/// load would be lost in their rounding. They are taken from the slack.
Vector moveRigidBodiesIntoContact(const Matrix& G, const std::vector<char>& active, Vector& slack);

/// Conditions that no free motion can change: both sides are held there.
std::vector<char> idleConditions(const Vector& diagonal);

}  // namespace mortier
