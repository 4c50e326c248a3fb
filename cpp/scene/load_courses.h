// The data of a scene in time, looked at before a run.
#pragma once

#include <string>
#include <vector>

#include "scene/scene.h"
#include "solver/model.h"
#include "time/breaks.h"

namespace mortier {

struct LoadCourses {
  std::vector<Course> data;    ///< what acts and varies, at points where it acts
  std::vector<double> breaks;  ///< their kinks and jumps and the breaks that the scene names, ascending [s]
};

/// Tables tell all of their kinks; expressions are tried at points where they act.
/// \throws InputError naming a datum that varies faster than can be sampled, or is not finite, and the point.
LoadCourses loadCourses(const SceneDescription& scene, const Model& model);

/// A warning for each datum that passes, within one of the equal steps of the scene, through values far
/// beyond those at both its ends.
std::vector<std::string> loadsBetweenSteps(const SceneDescription& scene, const Model& model);

}  // namespace mortier
