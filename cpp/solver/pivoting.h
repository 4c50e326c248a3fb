// How the active set of a contact problem is found: complementarity.h.
#pragma once

#include "solver/contact_sets.h"

namespace mortier {

/// From the set in `solution` to one where no force pulls and nothing overlaps. \returns false after all work
/// that is allowed, or where a matrix is redundant. \throws Interrupted
bool pivot(ContactSets& contact, ContactSolution& solution);

}  // namespace mortier
