// Solves the contact problem with friction (friction.h) on given sets, and finds the next ones by Newton's
// method: a condition is closed where p - g/W_ii > 0, a node sticks where |t - v/W_ii| <= b (semismooth
// Newton, Alart and Curnier 1991). Under fixed bounds (Tresca's law) in the plane changes of one condition at
// a time end where Newton's method goes round, as W is a P-matrix (Murty 1974).
#pragma once

#include <algorithm>
#include <cmath>
#include <limits>
#include <optional>

#include "base/two_part_vector.h"
#include "solver/dense_factor.h"
#include "solver/friction.h"

namespace mortier {

/// Residuals of sets that are right, and of those that differ by ties, are below it [-].
constexpr double roundingOfForces = 1e-13;

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

/// The linear equations of the conditions held, factorised (dense_factor.h):
///   W_held x - G_held z + softness x = f,   G_held' x + stiffness z = h,
/// where a follower acts with its leader's x, or the transposed equations.
class HeldSystem {
 public:
  HeldSystem(const ContactProblem& problem, HeldConditions held, double softness, double stiffness,
             bool transposed = false);
  /// f and h become x and z.
  void solve(Vector& f, Vector& h) const;
  [[nodiscard]] const HeldConditions& held() const { return held_; }
  [[nodiscard]] Eigen::Index size() const { return factor_.rows(); }
  /// 0 where the equations are singular.
  [[nodiscard]] double leastPivot() const { return factor_.leastPivot(); }
  [[nodiscard]] int sign() const { return factor_.sign(); }

 private:
  HeldConditions held_;
  double unit_ = 1;  ///< of z, in which G is as W
  DenseFactor factor_;
};

/// The contact problem in space with the conditions of each node along and across its direction of slip. Both
/// are nodes of a plane problem: one that slips and one that sticks, with the compliance of turning.
class AlignedProblem {
 public:
  AlignedProblem(const ContactProblem& problem, const FrictionLaw& law, const FrictionSets& sets);
  [[nodiscard]] const ContactProblem& problem() const { return problem_; }
  [[nodiscard]] const FrictionSets& sets() const { return sets_; }
  /// Forces or motions of all conditions, along and across the directions of slip.
  [[nodiscard]] Vector aligned(Vector x) const {
    turn(x, 1);
    return x;
  }
  /// The reverse.
  [[nodiscard]] Vector back(Vector x) const {
    turn(x, -1);
    return x;
  }
  /// -|v|/b t_e by conditions: the motions across the directions of slip under forces. [m]
  [[nodiscard]] Vector turning(const Vector& force) const { return -turning_.cwiseProduct(force); }

 private:
  void turn(Eigen::Ref<Vector> x, int way) const;

  std::vector<Point> directions_;  ///< by node
  Vector turning_;                 ///< by condition
  ContactProblem problem_;
  FrictionSets sets_;
};

class FrictionSystem {
 public:
  /// \param q  (g, v) without forces. What is given by reference must outlive this.
  FrictionSystem(const ContactProblem& problem, const Vector& q, Springs springs, FrictionWork& work);

  /// The same problem under fixed bounds |t| <= limit.
  [[nodiscard]] FrictionSystem underBounds(const Vector& limit) const;

  [[nodiscard]] const ContactProblem& problem() const { return problem_; }
  [[nodiscard]] const Springs& springs() const { return springs_; }
  /// W_ii, 1 of conditions that no free motion changes.
  [[nodiscard]] const Vector& compliance() const { return compliance_; }
  [[nodiscard]] FrictionWork& work() const { return work_; }
  [[nodiscard]] Eigen::Index normals() const { return problem_.normals(); }
  [[nodiscard]] const Vector& q() const { return q_; }
  /// Whether no free motion changes a condition.
  [[nodiscard]] bool idle(Eigen::Index condition) const { return idle_[condition] != 0; }
  /// Puts what no free motion changes into the sets: open across the line; along it, as the supports slip.
  void holdIdle(FrictionSets& sets) const;
  [[nodiscard]] int components() const { return problem_.along.components; }
  /// Whether t of a node is an unknown on the sets.
  [[nodiscard]] bool sticks(const FrictionSets& sets, Eigen::Index node) const;

  /// Everything closed and stuck.
  [[nodiscard]] FrictionSets allHeld() const;

  [[nodiscard]] HeldConditions heldOn(const FrictionSets& sets) const;
  /// Forces and motions on sets, under part of the load and of the limits; corrected by residuals in twice
  /// the working precision. \param start  (g, v) without forces. \returns nothing where `equations`, those
  /// of the sets, are singular but for rounding.
  [[nodiscard]] std::optional<FrictionSolution> solve(const HeldSystem& equations, const FrictionSets& sets,
                                                      double part, const TwoPartSums& start) const;

  /// Newton's method from `sets`. \returns the solution, or nothing where sets come back.
  std::optional<FrictionSolution> newton(FrictionSets sets) const;
  /// The next sets of Newton's method.
  [[nodiscard]] FrictionSets next(const FrictionSolution& trial) const;
  /// Forces and motions as a solution; nothing where they are none but for rounding.
  [[nodiscard]] std::optional<FrictionSolution> asSolution(FrictionSolution trial) const;
  /// For fixed bounds, in as many solves at most: changes of one condition where Newton's method goes round.
  std::optional<FrictionSolution> changeSingly(FrictionSets sets, int most) const;

 private:
  /// Forces and motions as the equations have them. \returns nothing where these are singular.
  [[nodiscard]] std::optional<FrictionSolution> solveOn(const FrictionSets& sets) const;
  [[nodiscard]] std::optional<FrictionSolution> solveInSpace(const FrictionSets& sets) const;
  void nextInSpace(const FrictionSolution& trial, const Vector& aim, Eigen::Index node,
                   FrictionSets& next) const;
  void clipInSpace(FrictionSolution& trial, Eigen::Index node) const;
  [[nodiscard]] std::optional<FrictionSolution> newtonInSpace(FrictionSets sets) const;
  /// The forces less those that the law demands of them and of the motions.
  [[nodiscard]] Vector offLaw(const FrictionSolution& trial) const;
  [[nodiscard]] double residual(const FrictionSolution& trial) const;
  /// mu p + c of a node.
  [[nodiscard]] double bound(const FrictionSolution& trial, Eigen::Index node) const;
  /// The first of its conditions.
  [[nodiscard]] Eigen::Index first(Eigen::Index node) const { return normals() + components() * node; }
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

/// The force within a bound that is nearest to this one.
inline Point withinBall(const Point& force, double limit) {
  const double size = force.norm();
  return size > limit ? Point(limit / size * force) : force;
}

/// In space: Newton's method after sweeps from zero forces, in which the forces of one node after the other
/// become those that its own motion demands (friction_sweeps.cpp; Jourdan, Alart and Jean 1998). Where
/// conditions depend on each other Newton's method may go round though sweeps come to an end.
std::optional<FrictionSolution> solveBySweeps(const FrictionSystem& system);

/// In space: the same problem with a compliance, small beside the others, along directions in which no free
/// motion changes the slip of a node.
ContactProblem withoutIdleSlips(const ContactProblem& problem);

/// The sets by following a path (friction_path.cpp).
/// \param beyond  how far below 0 tau goes, over the largest |q|/d [-]
/// \returns the sets on the passages through tau = 0, downwards (det A > 0) and upwards, in their order: the
/// first one, or all where the path goes beyond. Those so far where it cannot be followed: two events at one
/// tau that are not the same, or rounding.
std::vector<FrictionSets> followPath(const FrictionSystem& system, double beyond);

}  // namespace mortier
