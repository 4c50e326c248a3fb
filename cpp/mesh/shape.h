// Meshes by what they are of, in place of a file; the curves of their boundaries are known.
#pragma once

#include <variant>

#include "mesh/generate.h"
#include "mesh/outline.h"

namespace mortier {

struct MeshShape {
  std::variant<Rectangle, Quadrilateral, Annulus, HalfDisc, Outline> of;
  Cut cut = Cut::rising;
};

/// Labels as generate.h says; the edges of circles have their middles on them. \throws InputError
TriangleMesh shapeMesh(const MeshShape& shape);

}  // namespace mortier
