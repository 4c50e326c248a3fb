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

/// Bounds b = coefficient p + limit, by tangential condition.
struct FrictionLaw {
  Vector coefficient = {};  ///< mu [-]
  Vector limit = {};        ///< c [N/m]
};

/// The conditions along the line (friction.h), which come after all those across it.
struct FrictionRows {
  std::vector<int> node = {};  ///< the condition across whose p bounds each
  FrictionLaw law = {};
};

struct ContactProblem {
  Matrix W;                 ///< conditions x conditions; W_ii = 0 where no free motion changes one [m^2/N]
  bool symmetric = true;    ///< whether W is
  Matrix G;                 ///< conditions x rigid motions, none where all bodies are supported
  double forceScale = 0;    ///< scale of contact forces; rounding of the balance is relative to it [N/m]
  double proximal = 1e-9;   ///< weight of the proximal terms to begin with, over stiffness or compliance [-]
  FrictionRows along = {};  ///< none without friction

  /// The number of conditions across the line.
  [[nodiscard]] Eigen::Index normals() const {
    return W.rows() - static_cast<Eigen::Index>(along.node.size());
  }
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
  Vector change;                      ///< dp
  Vector rigid;                       ///< z
  std::vector<char> active;           ///< the set on which s = 0 was asked
  std::vector<signed char> slipping;  ///< with friction (friction.h), by the conditions along the line
  int pivots = 0;                     ///< active sets that were solved on
  double work = 0;                    ///< operations, over those of a factorisation of W [-]
  int idle = 0;                       ///< conditions that no free motion changes: W_ii = 0
  std::vector<Vector> motion;         ///< of the bodies (dofs), where they were not condensed
  bool dependent = false;             ///< conditions depend on each other: the forces are one choice of many
};

/// How many conditions depend on others: those that change, less the rank of W.
int dependentConditions(const Matrix& W);

/// More work than that of so many factorisations of W is not done for one contact problem.
constexpr double workLimit = 20;

/// Principal pivoting. First all conditions with a wrong sign change at once, as long as there are fewer of
/// them each time or two times in vain. Then forces that pull are dropped until none is left; then the
/// deepest condition of each run of neighbours that overlap is closed. A set that comes of it is kept where
/// it is better (by its energy where W is symmetric, else by the number of overlaps), or overlaps less than
/// any before. Otherwise fewer are closed, in the end one: where W is symmetric along the way on which the
/// energy falls (Lawson and Hanson 1974), else without opening up any other condition: its force grows
/// until its gap is closed, and conditions on the way that reach the end of their force or gap change
/// sides. That ends for every P-matrix (Cottle and Dantzig 1968). Factors are updated while the set changes
/// little (active_factor.h). The balance is held by a proximal term on z, small enough that one or two
/// repetitions make it exact (Rockafellar 1976). Conditions with W_ii = 0 stay inactive; where conditions
/// depend on each other the same kind of term on dp picks one of the solutions.
/// \param active  the set to begin with; of supported bodies without forces, all of it stands for what
/// overlaps without any.
ContactSolution solveContact(const ContactProblem& problem, const Vector& slack, const Vector& p0,
                             const Vector& balance, std::vector<char> active);

}  // namespace mortier
