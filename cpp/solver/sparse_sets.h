// The contact problem of a linearised step without dense matrices over its conditions.
#pragma once

#include "solver/contact_sets.h"
#include "solver/sparse_contact.h"

namespace mortier {

/// What a body is left with when contact is condensed away: nothing is. By the equations of all bodies
///   K d + C' dp = force,   s = slack - C d >= 0,   p = p0 + dp >= 0,   p s = 0.
/// \param problem  its W is not used. Ends like solveContact (complementarity.h), by the same pivoting.
/// \param motion  becomes d without the rigid motions of the solution.
ContactSolution solveSparse(SparseContact& matrix, const ContactProblem& problem, const Vector& force,
                            const Vector& slack, const Vector& p0, const Vector& balance,
                            std::vector<char> active, Vector& motion);

}  // namespace mortier
