// Principal pivoting for the contact problem of complementarity.h where W is regular: the balance is held by a proximal
// term on the rigid motions,
//   s = s0 + W dp - G z >= 0,   p = p0 + dp >= 0,   p s = 0,   G' dp + proximal (z - z0) = r.
// How the active set is found: complementarity.h.
#pragma once

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

class Pivoting {
 public:
  /// \param idle  conditions that stay inactive. All that is given by reference must outlive this.
  Pivoting(const ContactProblem& problem, const std::vector<char>& idle, const Vector& slack,
           const Vector& p0, const Vector& balance, Work& work);

  /// Begins anew with another slack.
  void restart(const Vector& slack);
  /// Weakens the proximal term: repetitions converge faster than at any fixed weight (Rockafellar 1976).
  void soften();
  /// Ends at the active set of the proximal problem around z0. \returns false after too much work, or where a
  /// matrix is redundant.
  bool run(const Vector& z0, ContactSolution& solution);

  /// Whether a matrix that was to be solved with is singular but for rounding.
  [[nodiscard]] bool redundant() const { return redundant_; }
  [[nodiscard]] bool capped() const { return work_.done > work_.limit || pivotsLeft_ <= 0; }
  /// What the proximal term still carries of the balance, against all forces in it, or those that are usual.
  [[nodiscard]] double imbalance(const ContactSolution& solution, const Vector& usual) const;
  /// Contact forces of the step before, and on closed conditions those that the rounding of gaps makes.
  [[nodiscard]] Vector usualForces(const ContactSolution& solution) const;
  /// Whether the load drives the bodies along a motion that opens contact or slides along it.
  [[nodiscard]] bool leaves(const ContactSolution& solution) const;

 private:
  /// Of a set that was solved on, and what is wrong with it.
  struct Signs {
    Vector slack;               ///< 0 on the set
    Vector force;               ///< p, not below 0
    std::vector<int> pulls;     ///< active, p < 0
    std::vector<int> overlaps;  ///< inactive, s < 0
  };

  bool dropPulls(const Vector& z0, ContactSolution& solution, Signs& signs);
  [[nodiscard]] bool isBetter(const Signs& next, const Signs& best) const;
  [[nodiscard]] Vector compliance(const Vector& p);
  Vector solveBordered(const std::vector<char>& active, const Vector& h, Vector& f);
  bool solveOn(const Vector& z0, ContactSolution& solution);
  [[nodiscard]] double residual(const ContactSolution& solution) const;
  [[nodiscard]] double sizeOf(const ContactSolution& solution) const;
  [[nodiscard]] Vector slackOf(const ContactSolution& solution);
  [[nodiscard]] Signs signsOf(const ContactSolution& solution);
  [[nodiscard]] std::vector<int> deepest(const Signs& signs, size_t count) const;
  void descend(const Vector& z0, int chosen, Vector p, ContactSolution& solution);
  void closeOne(const Vector& z0, int chosen, ContactSolution& solution);

  const ContactProblem& problem_;
  const std::vector<char>& idle_;
  Vector slack_;
  const Vector& p0_;
  const Vector& balance_;
  Work& work_;
  ActiveFactor factor_;
  Vector open_;  ///< slack of what was solved on last
  double stiffness_ = 0;
  double proximal_ = 0;
  int pivotsLeft_ = 0;  ///< in this run: sets of a few conditions cost next to nothing
  bool redundant_ = false;
};

}  // namespace mortier
