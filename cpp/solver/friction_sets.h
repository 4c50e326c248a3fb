// Solves the contact problem with friction (friction.h) on given sets, and finds the next ones by Newton's
// method: a condition is closed where p - g/W_ii > 0, a node sticks where |t - v/W_ii| <= b (semismooth
// Newton, Alart and Curnier 1991). Under fixed bounds (Tresca's law) changes of one condition at a time end
// where Newton's method goes round, as W is a P-matrix (Murty 1974).
#pragma once

#include <algorithm>
#include <cmath>
#include <limits>
#include <optional>

#include "base/two_part_vector.h"
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

/// The conditions of given sets whose forces are unknown: closed ones and nodes that stick. The force of a
/// slipping node follows that across it.
struct HeldConditions {
  std::vector<Eigen::Index> rows = {};
  struct Follower {
    Eigen::Index row;
    Eigen::Index leader;  ///< place in `rows`
    double part;          ///< +-mu
  };
  std::vector<Follower> followers = {};
};

class FrictionSystem {
 public:
  /// \param q  (g, v) without forces. What is given by reference must outlive this.
  FrictionSystem(const ContactProblem& problem, const Vector& q, Springs springs, FrictionWork& work);

  /// The same problem under fixed bounds |t| <= limit.
  [[nodiscard]] FrictionSystem underBounds(const Vector& limit) const;

  [[nodiscard]] const ContactProblem& problem() const { return problem_; }
  [[nodiscard]] const Springs& springs() const { return springs_; }
  [[nodiscard]] FrictionWork& work() const { return work_; }
  [[nodiscard]] Eigen::Index normals() const { return problem_.normals(); }
  [[nodiscard]] const Vector& q() const { return q_; }
  /// Whether no free motion changes a condition.
  [[nodiscard]] bool idle(Eigen::Index condition) const { return idle_[condition] != 0; }
  /// Puts what no free motion changes into the sets: open across the line; along it, as the supports slip.
  void holdIdle(FrictionSets& sets) const;
  /// Whether t of a tangential condition is an unknown on the sets.
  [[nodiscard]] bool sticks(const FrictionSets& sets, Eigen::Index tangential) const;

  /// Everything closed and stuck.
  [[nodiscard]] FrictionSets allHeld() const;

  [[nodiscard]] HeldConditions heldOn(const FrictionSets& sets) const;
  /// Their linear equations, [W + softness I, -unit G; unit G', unit^2 stiffness I].
  [[nodiscard]] Matrix matrix(const HeldConditions& held, double unit, double softness,
                              double stiffness) const;

  /// start + W x - G z, and part (load + stiffness z0) - G' x - stiffness z.
  [[nodiscard]] Vector motionOf(TwoPartSums start, const TwoPartVector& x, const TwoPartVector& z) const;
  [[nodiscard]] Vector unbalanced(double part, const TwoPartVector& x, const TwoPartVector& z) const;

  /// Newton's method from `sets`. \returns the solution, or nothing where sets come back.
  std::optional<FrictionSolution> newton(FrictionSets sets) const;
  /// For fixed bounds, in as many solves at most: changes of one condition where Newton's method goes round.
  std::optional<FrictionSolution> changeSingly(FrictionSets sets, int most) const;

 private:
  /// Forces and motions as the equations have them. \returns nothing where these are singular.
  [[nodiscard]] std::optional<FrictionSolution> solveOn(const FrictionSets& sets) const;
  [[nodiscard]] FrictionSets next(const FrictionSolution& trial) const;
  [[nodiscard]] double residual(const FrictionSolution& trial) const;
  /// mu p + c of a tangential condition.
  [[nodiscard]] double bound(const FrictionSolution& trial, Eigen::Index tangential) const;
  /// The same within its bounds, and exact on its sets.
  [[nodiscard]] FrictionSolution clipped(FrictionSolution trial) const;

  const ContactProblem& problem_;
  FrictionLaw law_;
  const Vector& q_;
  Springs springs_;
  FrictionWork& work_;
  std::vector<char> idle_;
  Vector compliance_;  ///< diagonal of W; 1 where idle
};

/// The sets by following a path (friction_path.cpp).
/// \param beyond  how far below 0 tau goes, over the largest |q|/d [-]
/// \returns the sets on the passages through tau = 0, downwards (det A > 0) and upwards, in their order: the
/// first one, or all where the path goes beyond. Those so far where it cannot be followed: two events at one
/// tau that are not the same, or rounding.
std::vector<FrictionSets> followPath(const FrictionSystem& system, double beyond);

}  // namespace mortier
