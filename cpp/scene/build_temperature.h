// The temperature of a body and what it strains: alpha T along the axes of each material.
#pragma once

#include "fem/body.h"
#include "scene/scene.h"

namespace mortier {

/// Adds the temperature to the conditions, and by `places`, the stress points of the mesh, what a kelvin
/// strains there. \throws InputError
void addTemperature(const BodyDescription& body, const TriangleMesh& mesh, Plane plane,
                    const std::vector<Point>& places, const std::vector<double>& times,
                    Conditions& conditions);

}  // namespace mortier
