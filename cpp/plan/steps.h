// The steps in time of a run that is to reach an accuracy: equal ones would leave an error that no mesh takes
// away, so where bodies flow or slip a part of what is asked (0.2 of it, 0.3 at degree 2) is their tolerance.
#pragma once

#include "scene/scene.h"

namespace mortier {

bool hasFriction(const SceneDescription& scene);

/// Whether a material of a body can flow.
bool mayFlow(const BodyDescription& body);

/// Whether a material of the scene can flow, or a contact has friction.
bool stepsMatter(const SceneDescription& scene);

/// Tolerance of the steps of a run, of its last round where it has several; 0: equal steps.
double stepTolerance(const SceneDescription& scene);

}  // namespace mortier
