#pragma once

#include <map>
#include <string>
#include <vector>

#include "scene/expression.h"

namespace mortier {

/// An expression of a scene in FreeFEM's language: every number real (FreeFEM divides integers as integers),
/// every a ? b : c in parentheses (FreeFEM nests them in no other way), FreeFEM's words.
/// \throws InputError for a word that FreeFEM does not know.
std::string freefemExpression(const Expression& expression);
/// An expression of other variables: `names` has what each is in FreeFEM.
std::string freefemFormula(const std::string& text, const std::string& where,
                           const std::map<std::string, std::string>& names);
/// The names in a text that are none of functions or constants, in their order.
std::vector<std::string> namesIn(const std::string& text);

}  // namespace mortier
