// The contact problem with friction once everything else is condensed away. For the nodal forces p across the
// contact and t along it, with x = (p, t), w = (g, v) and the rigid motions z of bodies that contact
// alone holds,
//   w = q + W x - G z,     G' x = load,   0 <= p _|_ g >= 0                (contact)
//   |t| <= b = mu p + c,   v > 0 => t = -b,   v < 0 => t = b               (friction)
// where g is the gap, v the slip of the step, W = C S^-1 C' the compliance against both, C = [C_n; C_t].
// c = 0 is Coulomb's law, mu = 0 is Tresca's. In space t and v of a node are vectors of two components,
//   |t| <= b,   v != 0 => t = -b v/|v|.
//
// Every solution belongs to a set (contact state): conditions are open or closed, nodes stick (v = 0), or
// slip forwards or backwards (t = b, t = -b); t is the force of the slipping body on the other one, in the
// direction of the slip. For a given set, p of the closed and t of the sticking nodes solve one dense
// unsymmetric system A. Sets are found by Newton's method on sets and, if that cycles, by a path-following
// method that terminates (friction_path.cpp): for every positive definite W there is a solution, whatever mu
// (docs/theory.md).
//
// In space the direction d of a slipping node is unknown, too. Newton's method linearises t = b d: along d
// the force follows the pressure, and across it the node sticks but for the compliance of turning,
//   t = (mu p + c) d + t_e e,   e . v + |v|/b t_e = 0,   e normal to d.
// Where it cycles, sweeps of node after node (friction_sweeps.cpp) go before it.
#pragma once

#include <vector>

#include "solver/complementarity.h"

namespace mortier {

/// The proximal term on rigid motions in place of their balance: G' x + stiffness (z - z0) = load.
struct Springs {
  Vector load = {};
  Vector z0 = {};
  double stiffness = 0;  ///< [N/m^2]
};

struct FrictionSets {
  std::vector<char> closed;  ///< by normal condition
  /// By node with friction: the sign of t, against v, and 1 in space; 0: it sticks where it can.
  std::vector<signed char> slip;
  std::vector<SlipDirection> directions = {};  ///< the same in space; empty in the plane

  friend bool operator==(const FrictionSets& a, const FrictionSets& b) {
    return a.closed == b.closed && a.slip == b.slip && a.directions == b.directions;
  }
};

/// What finding a solution took, and what was met on the way.
struct FrictionWork {
  int solves = 0;          ///< dense systems that were solved
  int events = 0;          ///< changes of set on the path, 0 where none was taken
  bool ambiguous = false;  ///< sets with det A < 0 were met: with some other q this problem has several
                           ///< solutions (docs/decisions.md)
  bool swept = false;      ///< in space: sweeps led to no solution
  bool singular = false;   ///< a system was singular but for rounding: conditions depend on each other, and
                           ///< where it is solved x is one choice of many
};

struct FrictionSolution : FrictionWork {
  bool solved = false;
  Vector force = {};   ///< x = (p, t), within its bounds [N/m]
  Vector motion = {};  ///< w = (g, v), exactly 0 where a set demands it [m]
  FrictionSets sets = {};
  /// How far x is from what its own g and v demand, over the largest force or what would close the widest
  /// gap [-].
  double residual = 0;
  int index = 1;         ///< sign of det A: 1 but for solutions that no path of loads leads to
  bool balanced = true;  ///< contact carries the load on rigid motions
  Vector rigid = {};     ///< z, or where unbalanced the motion in which the bodies slide, tip or part [m]
};

/// \param q  (g, v) without forces [m]. \param load  of the balance [N/m]. \param first  the sets to begin
/// with, as those of the step before. \param all  becomes the solutions found by solutionsOnPath().
FrictionSolution solveFriction(const ContactProblem& problem, Vector q, FrictionSets first,
                               const Vector& load = {}, std::vector<FrictionSolution>* all = nullptr);

/// All solutions that the path (friction_path.cpp) meets, each once, in its order. Its first passage through
/// tau = 0 is a solution with det A > 0. If there are others, as for a wedge that jams, slides, or is in an
/// unstable state in between (det A < 0), the path continued beyond tau = 0 returns to most of them.
/// \param taken  one that is known, first in the list.
std::vector<FrictionSolution> solutionsOnPath(const ContactProblem& problem, const Vector& q,
                                              const Springs& springs, const FrictionSolution& taken);

}  // namespace mortier
