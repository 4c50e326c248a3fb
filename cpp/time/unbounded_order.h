// Places where stresses are unbounded, such as sharp corners: largest values there have no limit.
#pragma once

#include "solver/model.h"
#include "solver/state.h"

namespace mortier {

/// a, where stresses near a place are unbounded like r^-a, so that the energy in discs around it goes like
/// r^(2 - 2a) in one of the bodies. 0 where they seem bounded, and where meshes are too coarse to tell.
double unboundedOrder(const Model& model, const State& state, const Point& place);

}  // namespace mortier
