// Which displacements of a mesh the conditions of a body prescribe along x and y.
#pragma once

#include <optional>
#include <vector>

#include "mesh/triangle_mesh.h"
#include "scene/scene.h"

namespace mortier {

/// The axis (0: x, 1: y) along which a component (fem/supports.h) of an edge is; none where it is oblique.
std::optional<int> axisOf(int component, const Point& from, const Point& to);

/// Per dof 2 vertex + axis, whether a displacement is prescribed.
std::vector<char> heldDofs(const TriangleMesh& mesh, const std::vector<ConditionDescription>& conditions);

}  // namespace mortier
