// The contact problem with friction once everything else is condensed away. For the nodal forces p across the
// contact line and t along it, with x = (p, t) and w = (g, v),
//   w = q + W x,     0 <= p _|_ g >= 0                                  (contact)
//   |t| <= b = mu p + c,   v > 0 => t = -b,   v < 0 => t = b            (friction)
// where g is the gap, v the slip of the step, W = C S^-1 C' the compliance against both, C = [C_n; C_t].
// c = 0 is Coulomb's law, mu = 0 is Tresca's.
//
// Every solution belongs to a set (contact state): conditions are open or closed, nodes stick (v = 0), or
// slip forwards or backwards (t = b, t = -b); t is the force of the slipping body on the other one, in the
// direction of the slip. For a given set, p of the closed and t of the sticking nodes solve one dense
// unsymmetric system A. Sets are found by Newton's method on sets and, if that cycles, by a path-following
// method that terminates (friction_path.h): for every positive definite W there is a solution, whatever mu
// (docs/theory.md).
#pragma once

#include <vector>

#include "base/types.h"

namespace mortier {

/// Bounds b = coefficient p + limit, by tangential condition.
struct FrictionLaw {
  Vector coefficient;  ///< mu [-]
  Vector limit;        ///< c [N/m]
};

/// The conditions along the line, which come after all those across it.
struct FrictionRows {
  std::vector<int> node;  ///< the condition across whose p bounds each
  FrictionLaw law;
};

/// Rigid motions z that only contact holds, and springs on them (friction_motions.h):
///   w = q + W x - G z,   G' x + spring (z - z0) = load.
struct FreeMotions {
  Matrix G;              ///< conditions x motions
  Vector load;           ///< on the motions [N/m]
  Vector z0;             ///< [m]
  double spring = 0;     ///< [N/m^2]
  double stiffness = 0;  ///< of contact against the motions, about [N/m^2]
};

struct FrictionProblem {
  /// Of all conditions [m^2/N]. One that no free motion changes has a zero on the diagonal and no force.
  const Matrix& W;
  const FrictionRows& rows;
  const FreeMotions* motions = nullptr;  ///< none where supports hold all bodies

  [[nodiscard]] Eigen::Index normals() const {
    return W.rows() - static_cast<Eigen::Index>(rows.node.size());
  }
};

struct FrictionSets {
  std::vector<char> closed;  ///< by normal condition
  std::vector<signed char>
      slip;  ///< by tangential condition, the sign of t, against v; 0: it sticks where it can

  friend bool operator==(const FrictionSets& a, const FrictionSets& b) {
    return a.closed == b.closed && a.slip == b.slip;
  }
};

struct FrictionSolution {
  bool solved = false;
  Vector force;   ///< x = (p, t), within its bounds [N/m]
  Vector motion;  ///< w = (g, v), exactly 0 where a set asks it [m]
  FrictionSets sets;
  /// How far x is from what its own g and v ask of it, over the largest force or what would close the widest
  /// gap [-].
  double residual = 0;
  int index = 0;          ///< sign of det A: 1 but for solutions that no path of loads leads to
  int solves = 0;         ///< dense systems that were solved
  int events = 0;         ///< changes of set on the path, 0 where none was taken
  bool singular = false;  ///< a system was singular but for rounding: conditions depend on each other, and
                          ///< where it is solved x is one choice of many
  Vector rigid = {};      ///< z, of free motions [m]
  /// Whether sets with det A < 0 were met: with some other q this problem has several solutions
  /// (docs/decisions.md).
  bool ambiguous = false;
};

/// \param q  (g, v) without forces [m]. \param first  the sets to begin with, as those of the step before.
FrictionSolution solveFriction(const FrictionProblem& problem, const Vector& q, const FrictionSets& first);

}  // namespace mortier
