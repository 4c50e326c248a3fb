// The contact problem of complementarity.h where W is regular, on one active set after the other. The balance
// is held by a proximal term on the rigid motions,
//   s = s0 + W dp - G z,   p = p0 + dp,   G' dp + proximal (z - z0) = r,   s_A = 0,   p = 0 off A.
#pragma once

#include <Eigen/LU>
#include <limits>
#include <vector>

#include "solver/active_factor.h"
#include "solver/complementarity.h"

namespace mortier {

/// Operations done for a contact problem, and how many are allowed.
struct Work {
  explicit Work(const ContactProblem& problem);
  double factorisation = 0;
  double limit = 0;
  double done = 0;
};

class ProximalContact {
 public:
  /// \param idle  conditions that stay inactive. All that is given by reference must outlive this.
  ProximalContact(const ContactProblem& problem, const std::vector<char>& idle, const Vector& slack,
                  const Vector& p0, const Vector& balance, Work& work);

  /// Begins anew with another slack.
  void restart(const Vector& slack);
  /// Sets z0, and how many solves are allowed until the next call.
  void centre(const Vector& z0);
  /// Weakens the proximal term: repetitions converge faster than at any fixed weight (Rockafellar 1976).
  void soften();

  /// dp and z on solution.active. \returns false where that is redundant.
  bool solveOn(ContactSolution& solution);
  /// The same with factors of the set itself, if those in use are not.
  bool refactor(const std::vector<char>& active);
  [[nodiscard]] bool fresh() const { return factor_.fresh(); }

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
  bool grow(int condition, ContactSolution& solution, Growth& growth);

  /// Values below this part of the largest are rounding.
  static constexpr double rounding = 64 * std::numeric_limits<double>::epsilon();

  [[nodiscard]] const ContactProblem& problem() const { return problem_; }
  [[nodiscard]] const Vector& p0() const { return p0_; }
  /// Slack of the set that was solved on last, of closed conditions the rounding.
  [[nodiscard]] const Vector& slack() const { return open_; }
  [[nodiscard]] bool idle(int condition) const { return idle_[condition] != 0; }
  /// Whether a matrix that was to be solved with is singular but for rounding.
  [[nodiscard]] bool redundant() const { return redundant_; }
  /// Whether all work or all solves that are allowed were done.
  [[nodiscard]] bool capped() const { return work_.done > work_.limit || pivotsLeft_ <= 0; }
  /// What the proximal term still carries of the balance, against all forces in it, or those that are usual.
  [[nodiscard]] double imbalance(const ContactSolution& solution, const Vector& usual) const;
  /// Contact forces of the step before, and on closed conditions those that the rounding of gaps makes.
  [[nodiscard]] Vector usualForces(const ContactSolution& solution) const;
  /// Whether the load drives the bodies along a motion that opens contact or slides along it.
  [[nodiscard]] bool leaves(const ContactSolution& solution) const;

 private:
  [[nodiscard]] Vector compliance(const Vector& p);
  bool take(const std::vector<char>& active);
  Vector solve(const Vector& h, Vector& f);
  [[nodiscard]] double residual(const ContactSolution& solution) const;
  [[nodiscard]] double sizeOf(const ContactSolution& solution) const;

  const ContactProblem& problem_;
  const std::vector<char>& idle_;
  Vector slack_;
  const Vector& p0_;
  const Vector& balance_;
  Vector z0_;
  Work& work_;
  ActiveFactor factor_;
  Vector open_;           ///< slack of the set that was solved on last
  double stiffness_ = 0;  ///< of all nodes together against rigid motions
  double proximal_ = 0;
  Matrix held_, free_;  ///< motions that the set resists, and those that it does not
  Matrix forces_;       ///< W_AA^-1 G_A held
  Eigen::PartialPivLU<Matrix> stiffnessFactor_;
  int pivotsLeft_ = 0;  ///< sets of a few conditions cost next to no work
  bool redundant_ = false;
};

}  // namespace mortier
