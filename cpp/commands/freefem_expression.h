#pragma once

#include <string>

#include "scene/expression.h"

namespace mortier {

/// An expression of a scene in FreeFEM's language: every number real (FreeFEM divides integers as integers),
/// every a ? b : c in parentheses (FreeFEM nests them in no other way), FreeFEM's words.
/// \throws InputError for a word that FreeFEM does not know.
std::string freefemExpression(const Expression& expression);

}  // namespace mortier
