// `mesh = { shape = "rectangle", ... }` of a [[body]]: a mesh by what it is of.
#pragma once

#include "mesh/shape.h"
#include "scene/table_reader.h"

namespace mortier {

/// \param table  that has the key `shape`
/// \throws InputError with one line `file:line: body NAME: mesh: key = value, expected ...`.
MeshShape readShape(const TableReader& table);

}  // namespace mortier
