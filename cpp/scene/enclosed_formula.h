// Formulas in x, y and t over pieces of lines (base/taylor.h).
#pragma once

#include <string>

#include "base/datum.h"

namespace mortier {

/// Empty where the text is no formula (scene/formulas.h).
Datum::Along enclosed(const std::string& text);

}  // namespace mortier
