// The value of a datum, or what is wrong with it.
#pragma once

#include "scene/expression.h"

namespace mortier {

/// The value of the expression. Where that is not finite the function \throws DatumError naming the datum,
/// the point and the time.
Datum finiteValue(const Expression& expression);
/// The same in space.
SpaceDatum finiteInSpace(const Expression& expression);
/// One of them.
SpaceDatum finiteAt(const Expression& expression, bool inSpace);

}  // namespace mortier
