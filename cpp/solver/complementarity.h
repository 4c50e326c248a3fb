// The contact problem once everything else is condensed away: the linear complementarity problem
//   p >= 0,   s = q + W p >= 0,   p s = 0                                                                    (contact)
// with the contact compliance W = C S^-1 C' (nonmortar nodes squared, W_ii > 0) and the slack s = g0 - C u.
#pragma once

#include <vector>

#include "base/types.h"

namespace mortier {

struct Complementarity {
  Vector p;                  ///< contact forces
  std::vector<char> active;  ///< p > 0 or on the edge of it
  int pivots = 0;            ///< dense solves
  bool solved = false;       ///< false only where W is not a P-matrix (an indefinite tangent)
};

/// Principal pivoting. All wrong signs change sides at once; when that stops helping, one at a time by the least index,
/// which ends after finitely many steps for every P-matrix, symmetric or not (Murty 1974; Judice and Pires 1994).
/// \param slack  s at p0; the solution is sought as a change of p0, so that a good p0 costs no accuracy.
/// \param active  the set to begin with.
Complementarity solveComplementarity(const Matrix& W, bool symmetric, const Vector& slack, const Vector& p0,
                                     std::vector<char> active);

}  // namespace mortier
