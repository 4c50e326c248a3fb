// The contact problem once everything else is condensed away: the mixed linear complementarity problem
//   s = s0 + W dp - G z >= 0,   p = p0 + dp >= 0,   p s = 0     (contact)
//   G' dp = r                                                   (balance of rigid motions)
// for the change dp of the contact forces and the rigid motions z of bodies held by contact alone.
// W = C S^-1 C' is the contact compliance, G = C R the normal motion of the nonmortar nodes under rigid
// motions, s the slack g0 - C u, r the part of the load that only contact can balance.
#pragma once

#include <vector>

#include "base/types.h"

namespace mortier {

/// Bounds b = coefficient p + limit, by node with friction.
struct FrictionLaw {
  Vector coefficient = {};  ///< mu [-]
  Vector limit = {};        ///< c [N/m]
};

/// The conditions along contact (friction.h), which come after all those across it, node by node.
struct FrictionRows {
  std::vector<int> node = {};  ///< by node with friction, the condition across whose p bounds its force
  FrictionLaw law = {};
  int components = 1;  ///< conditions of a node: 1 in the plane, 2 in space

  [[nodiscard]] Eigen::Index conditions() const {
    return components * static_cast<Eigen::Index>(node.size());
  }
};

/// How a node slips in space, by its two directions of slip.
struct SlipDirection {
  Point along = Point::Zero();  ///< of t, a unit vector
  double turning = 0;           ///< |v|/|t|: slip across it for a force across it [m^2/N]

  friend bool operator==(const SlipDirection& a, const SlipDirection& b) {
    return a.along == b.along && a.turning == b.turning;
  }
};

struct ContactProblem {
  Matrix W;                 ///< conditions x conditions; W_ii = 0 where no free motion changes one [m^2/N]
  bool symmetric = true;    ///< whether W is
  Matrix G;                 ///< conditions x rigid motions, none where all bodies are supported
  double forceScale = 0;    ///< scale of contact forces; rounding of the balance is relative to it [N/m]
  double proximal = 1e-9;   ///< weight of the proximal terms to begin with, over stiffness or compliance [-]
  FrictionRows along = {};  ///< none without friction

  /// The number of conditions across the line.
  [[nodiscard]] Eigen::Index normals() const { return W.rows() - along.conditions(); }
};

struct ContactSolution {
  enum class Outcome {
    solved,
    unbalanced,  ///< contact cannot balance r: `rigid` is the motion along which the bodies leave
    cycled,      ///< only where W is not a P-matrix (an indefinite tangent), or nearly so
    dependent,   ///< conditions with friction depend on each other
    capped       ///< all pivots, or all the work, that are allowed were done: `workLimit` factorisations of W
  };
  Outcome outcome = Outcome::cycled;
  Vector change;                          ///< dp
  Vector rigid;                           ///< z
  std::vector<char> active;               ///< the set on which s = 0 was asked
  std::vector<signed char> slipping;      ///< with friction (friction.h), by node with friction
  std::vector<SlipDirection> directions;  ///< the same in space; empty in the plane
  int pivots = 0;                         ///< active sets that were solved on
  double work = 0;                        ///< operations, over those of a factorisation of W [-]
  int idle = 0;                           ///< conditions that no free motion changes: W_ii = 0
  std::vector<Vector> motion;             ///< of the bodies (dofs), where they were not condensed
  bool dependent = false;  ///< conditions depend on each other: the forces are one choice of many
};

/// How many conditions depend on others: those that change, less the rank of W.
int dependentConditions(const Matrix& W);

/// More work than that of so many factorisations of W is not done for one contact problem.
constexpr double workLimit = 20;

/// Principal pivoting on the active set:
/// 1. Semismooth Newton: all conditions under tension leave the set and all that penetrate join it, while
///    they become fewer, or two times in vain.
/// 2. Conditions under tension leave until there are none.
/// 3. Of each run of neighbours that penetrate the deepest joins, and 2 follows. The set is accepted where
///    its energy is lower (W symmetric) or fewer conditions penetrate (else), or where the penetration is
///    less than that of any set before.
/// 4. Otherwise fewer conditions join, in the end one. W symmetric: along the way on which the energy falls
///    (Lawson and Hanson 1974). Else its force grows until its gap is closed, and conditions whose force or
///    gap vanishes on the way change sides (Cottle and Dantzig 1968). That ends for every P-matrix.
/// Factors are updated while the set changes little (proximal_contact.h). A proximal term on z makes the
/// balance exact in one or two repetitions (Rockafellar 1976). Conditions with W_ii = 0 stay inactive. Where
/// conditions depend on each other, a proximal term on dp selects one of the solutions.
/// \param active  the set to begin with. Of supported bodies without forces a full set stands for the
/// conditions that penetrate without forces.
ContactSolution solveContact(const ContactProblem& problem, const Vector& slack, const Vector& p0,
                             const Vector& balance, std::vector<char> active);

}  // namespace mortier
