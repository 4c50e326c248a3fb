// The data of a scene in time, looked at before a run.
#pragma once

#include <string>
#include <vector>

#include "mesh/tetrahedron_mesh.h"
#include "mesh/triangle_mesh.h"
#include "scene/expression.h"
#include "scene/scene.h"
#include "solver/model.h"
#include "time/breaks.h"

namespace mortier {

struct LoadCourses {
  std::vector<Course> data;    ///< what acts and varies, at points where it acts
  std::vector<double> breaks;  ///< their kinks and jumps and the breaks that the scene names, ascending [s]
};

/// Tables have all of their kinks; expressions are tried at points where they act.
/// \throws InputError naming a datum that varies faster than can be sampled, or is not finite, and the point.
LoadCourses loadCourses(const SceneDescription& scene, const Model& model);

/// A warning for each datum that passes, within one of the equal steps of the scene, through values far
/// beyond those at both its ends.
std::vector<std::string> loadsBetweenSteps(const SceneDescription& scene, const Model& model);

// Where and when a datum is to be looked at so that its whole course in time is seen: its values at places of
// all edges or triangles where it acts, of which those are kept whose courses are no combinations of others,
// and what its enclosure (base/datum.h) allows and no sample has.

struct LoadPlaces {
  std::vector<SpacePoint> points;  ///< z = 0 in the plane
  std::vector<double> times;  ///< of peaks that samples from the beginning to the end would miss, ascending
};

/// \param label  of the edges or triangles where it acts; all of the mesh where null
template <class Mesh>
LoadPlaces loadPlaces(const Expression& datum, const Mesh& mesh, const int* label, const TimePlan& time);
/// Of one that acts at a point.
LoadPlaces loadPlaces(const Expression& datum, const SpacePoint& point, const TimePlan& time);

}  // namespace mortier
