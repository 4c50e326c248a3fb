// The [time] of a scene: equal steps, or steps chosen by their error.
#pragma once

#include "scene/document.h"
#include "time/plan.h"

namespace mortier {

/// \throws InputError with one line `file:line: time: key = value, expected ...`.
TimePlan readTime(const Node& node);

}  // namespace mortier
