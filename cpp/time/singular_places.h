// Places where stresses are unbounded, so that largest values have no limit: by the order that is measured
// (unbounded_order.cpp) and, where that is too coarse, by the angles and the supports of corners, in space of
// edges. Stresses are bounded at a convex corner with both sides free or both held, at most of a right angle
// where one side is held along its normal alone (half of one of twice the angle), and where one side is held
// and the other one free up to the angle w with sin^2 w = (kappa + 1)/4 (Williams 1952), kappa = 3 - 4 nu, in
// plane stress (3 - nu)/(1 + nu).
#pragma once

#include "solver/model.h"
#include "solver/state.h"

namespace mortier {

/// a, where stresses near a place are unbounded like r^-a, so that the energy in discs around it goes like
/// r^(2 - 2a) in one of the bodies, that in balls in space like r^(3 - 2a). 0 where they seem bounded, and
/// where meshes are too coarse.
double unboundedOrder(const Model& model, const State& state, const SpacePoint& place);

/// Of a side of a corner.
enum class SideSupport { free, sliding, held };

/// Whether stresses at a corner are clearly unbounded, like r^-a with a of at least about 0.15.
bool isSingular(double angle, SideSupport first, SideSupport second, double kappa);

/// Whether there is such a corner, or end of a support, of a body next to a place, in space such an edge, and
/// the stress grows towards it.
bool cornerAt(const Body& body, const Matrix& stress, const SpacePoint& place);

/// Whether contact that presses, or a tie, ends next to a place at a corner of one body, in space at an edge,
/// while the other one continues, and the stress grows towards it: its pressure may be unbounded.
/// \param reach  how far next to a place is at least [m]
bool contactEndsAt(const Model& model, const State& state, const SpacePoint& place, double reach = 0);

}  // namespace mortier
