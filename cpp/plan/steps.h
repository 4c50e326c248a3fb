// The steps in time of a run that is to reach an accuracy: equal ones would leave an error that no mesh takes
// away, so where bodies flow a part of what is asked (0.2 of it, 0.3 at degree 2) is their tolerance.
#pragma once

#include "scene/scene.h"

namespace mortier {

/// Whether a material of the scene can flow.
bool canFlow(const SceneDescription& scene);

/// Tolerance of the steps of a run, of its last round where it has several; 0: equal steps.
double stepTolerance(const SceneDescription& scene);

}  // namespace mortier
