// The contact problem with friction (friction.h) of bodies held by contact alone, with rigid motions z,
//   w = q + W x - G z,     G' x = f,
// and the load f on these motions. A proximal term (as in complementarity.h) acts like springs on them, G' x
// + spring (z - z0) = f, where z0 is set to z and the problem solved again until the spring forces vanish.
// Eliminating z replaces W by W + G G'/spring, so solveFriction applies. If equilibrium is impossible, the
// last change of z is the motion in which bodies slide, tip or separate.
#pragma once

#include "solver/friction.h"

namespace mortier {

struct LooseFriction {
  FrictionSolution solution;
  Vector rigid;                            ///< z, or where unbalanced the motion of the bodies [m]
  bool balanced = false;                   ///< f is carried by contact
  std::vector<FrictionSolution> all = {};  ///< where they are asked for (friction_solutions.h)
};

/// \param W, G  by conditions; symmetric or not. \param load  f. \param usual  a contact force beside which
/// an imbalance is nothing but rounding. \param weight  of the springs, over the stiffness of contact [-].
/// \param listAll  whether other solutions are looked for, under the springs of the last repetition.
LooseFriction solveLooseFriction(const Matrix& W, const FrictionRows& rows, const Matrix& G,
                                 const Vector& load, double usual, double weight, Vector q,
                                 FrictionSets first, bool listAll = false);

}  // namespace mortier
