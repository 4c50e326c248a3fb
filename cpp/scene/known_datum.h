// What the text of an expression in x, y, t and z says about it without trying it at points: its degree in x,
// y and z, and enclosures of it and its derivatives (base/taylor.h).
#pragma once

#include <string>

#include "base/datum.h"

namespace mortier {

/// Fills in the degree and the enclosures of a datum of that text; nothing where it is not a formula.
void describe(const std::string& text, Datum& datum);

}  // namespace mortier
