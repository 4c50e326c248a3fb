// Solves the contact problem with friction (friction.h) on given sets, and finds the next ones by Newton's
// method: a condition is closed where p - g/W_ii > 0, a node sticks where |t - v/W_ii| <= b (semismooth
// Newton, Alart and Curnier 1991). Under fixed bounds (Tresca's law) changes of one condition at a time end
// where Newton's method goes round, as W is a P-matrix (Murty 1974).
#pragma once

#include <algorithm>
#include <cmath>
#include <limits>
#include <optional>

#include "base/two_part_sums.h"
#include "solver/dense_factor.h"
#include "solver/friction.h"

namespace mortier {

/// Corrections of a solution by residuals in twice the working precision.
class Corrections {
 public:
  /// \param cancels  the size of what cancels in the solution.
  explicit Corrections(double cancels = 0) : largest_(cancels) {}

  /// Takes the size of one and that of the solution. \returns whether another one is worth while.
  bool goOn(double change, double size) {
    constexpr double enough = 1e-10;  // each is less by the square of that
    constexpr double zero = 1e-26;
    largest_ = std::max(largest_, size);
    if (!(change > std::max(enough * size, zero * largest_))) return false;
    if (!(change < before_ / 2)) {
      failed_ = true;
      return false;
    }
    before_ = std::isinf(before_) ? std::max(change, largest_) : change;
    return true;
  }
  /// Whether they do not become less: the matrix is singular to rounding.
  [[nodiscard]] bool failed() const { return failed_; }

 private:
  double largest_ = 0;
  double before_ = std::numeric_limits<double>::infinity();
  bool failed_ = false;
};

class FrictionSystem {
 public:
  /// \param q  (g, v) without forces; must outlive this, as what the problem refers to.
  FrictionSystem(const FrictionProblem& problem, const Vector& q);

  [[nodiscard]] const FrictionProblem& problem() const { return problem_; }
  [[nodiscard]] Eigen::Index normals() const { return problem_.normals(); }
  [[nodiscard]] const Vector& q() const { return q_; }
  /// Whether no free motion changes a condition.
  [[nodiscard]] bool idle(Eigen::Index condition) const { return idle_[condition] != 0; }
  /// Puts what no free motion changes into the sets: open across the line; along it, as the supports slip.
  void holdIdle(FrictionSets& sets) const;
  /// Whether t of a tangential condition is an unknown on the sets.
  [[nodiscard]] bool sticks(const FrictionLaw& law, const FrictionSets& sets, size_t tangential) const;

  /// Everything closed and stuck.
  [[nodiscard]] FrictionSets allHeld() const;

  /// start + W x - G z, and part (load + spring z0) - G' x - spring z.
  [[nodiscard]] Vector motionOf(TwoPartSums start, const TwoPartVector& x, const TwoPartVector& z) const;
  [[nodiscard]] Vector unbalanced(double part, const TwoPartVector& x, const TwoPartVector& z) const;

  /// Newton's method from `sets`. \returns the solution, or nothing where sets come back.
  std::optional<FrictionSolution> newton(const FrictionLaw& law, FrictionSets sets);
  /// Under fixed bounds |t| <= limit, in as many solves at most.
  std::optional<FrictionSolution> bounded(const Vector& limit, FrictionSets sets, Eigen::Index most);

  [[nodiscard]] int solves() const { return solves_; }
  [[nodiscard]] bool singular() const { return singular_; }
  /// Whether det A < 0 on any sets that were solved on.
  [[nodiscard]] bool ambiguous() const { return ambiguous_; }

 private:
  struct Trial {
    Vector force;
    Vector motion;
    int index = 1;
    Vector rigid = {};
  };
  bool solveOn(const FrictionLaw& law, const FrictionSets& sets, Trial& trial);
  [[nodiscard]] FrictionSets next(const FrictionLaw& law, const FrictionSets& sets, const Trial& trial) const;
  [[nodiscard]] double residual(const FrictionLaw& law, const Trial& trial) const;
  [[nodiscard]] FrictionSolution solution(const FrictionLaw& law, const FrictionSets& sets,
                                          const Trial& trial) const;

  FrictionProblem problem_;
  const Vector& q_;
  Vector compliance_;  ///< diagonal of W; 1 where idle
  std::vector<char> idle_;
  int solves_ = 0;
  bool singular_ = false;
  bool ambiguous_ = false;
};

}  // namespace mortier
