// The labels and points that a scene names, looked up in the mesh of the body.
#pragma once

#include <string>

#include "mesh/triangle_mesh.h"

namespace mortier {

/// The number of a label of the boundary that a scene gives as a number or, unless `name` is empty, as a
/// name.
/// \throws InputError, headed by `place` ("scene.toml:9: body upper"), with the labels that the mesh has.
int boundaryLabel(const TriangleMesh& mesh, int label, const std::string& name, const std::string& place);

/// The same for a label of a region.
int regionLabel(const TriangleMesh& mesh, int label, const std::string& name, const std::string& place);

/// Where the vertex lies that a scene means by a point: the nearest one, no further off than a thousandth of
/// the shortest edge there.
/// \throws InputError, headed by `place`, with that vertex and its distance.
Point vertexPoint(const TriangleMesh& mesh, const Point& point, const std::string& place);

}  // namespace mortier
