// Where and when a datum is to be looked at so that its whole course in time is seen: its values at places of
// all edges or triangles where it acts, of which those are kept whose courses are no combinations of others,
// and what its enclosure (base/datum.h) allows and no sample has.
#pragma once

#include <vector>

#include "mesh/tetrahedron_mesh.h"
#include "mesh/triangle_mesh.h"
#include "scene/expression.h"

namespace mortier {

struct LoadPlaces {
  std::vector<SpacePoint> points;  ///< z = 0 in the plane
  std::vector<double> times;       ///< of peaks that samples between 0 and the end would miss, ascending
};

/// \param label  of the edges or triangles where it acts; all of the mesh where null
LoadPlaces loadPlaces(const Expression& datum, const TriangleMesh& mesh, const int* label, double end);
LoadPlaces loadPlaces(const Expression& datum, const TetrahedronMesh& mesh, const int* label, double end);
/// Of one that acts at a point.
LoadPlaces loadPlaces(const Expression& datum, const SpacePoint& point, double end);

}  // namespace mortier
