// The bound of the error of a run's last state (bound/energy_bound.h).
#pragma once

#include "bound/energy_bound.h"
#include "scene/scene.h"

namespace mortier {

/// What stops it, an interruption or a lack of memory, is its obstacle: it does not take the result away.
EnergyBound boundOf(const Model& model, const State& state, const std::vector<Functional>& functionals = {});

/// The quantities of a scene as a bound needs them.
std::vector<Functional> functionalsOf(const std::vector<Quantity>& quantities, const SceneDescription& scene);

}  // namespace mortier
