// Laws of one's own in a scene: expressions, and laws that a program has registered.
#pragma once

#include "material/own_material.h"
#include "scene/table_reader.h"

namespace mortier {

/// Whether the table's `law` is a registered one.
bool isRegistered(const TableReader& table);
/// The words and the names of registered laws.
Keys withRegistered(Keys words);

/// law = "expression": rate11, rate22, rate12, rate33 in s11, s22, s12, s33, e11, e22, e12, e33 and what
/// `parameters` names, numbers and expressions. \throws InputError
OwnLaw readExpressionLaw(const TableReader& table);
/// \throws InputError
OwnLaw readRegisteredLaw(const TableReader& table);

}  // namespace mortier
