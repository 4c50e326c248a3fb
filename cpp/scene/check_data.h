// Data of a body tried where they act, before the run needs them.
#pragma once

#include <vector>

#include "fem/supports.h"
#include "scene/scene.h"

namespace mortier {

/// Displacements, tractions, forces and initial stresses, at points where each acts and at the times [s].
/// \throws InputError with the first value that is not finite.
void requireFiniteData(const BodyDescription& body, const TriangleMesh& mesh,
                       const std::vector<double>& times);

/// Where labels or points meet, all may prescribe a motion of a node, but not differently. `displacements`
/// are the conditions of `supports`, in their order. \throws InputError with node, time [s] and both values
/// [m].
void requireOneDisplacement(const Supports& supports,
                            const std::vector<const ConditionDescription*>& displacements,
                            const TriangleMesh& mesh, const std::vector<double>& times);

}  // namespace mortier
