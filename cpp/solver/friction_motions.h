// The contact problem with friction (friction.h) of bodies that contact alone holds, z their rigid motions,
//   w = q + W x - G z,     G' x = f,
// f the load on the motions. Springs are put on them, G' x + spring (z - z0) = f, and z0 follows z until they
// carry nothing (a proximal term, as in complementarity.h). To the springs' eyes W is W + G G'/spring, so all
// that is known of solveFriction holds. Where the balance cannot be met the last change of z is the motion in
// which bodies slide, tip or leave.
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
