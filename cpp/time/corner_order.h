// Places where stresses are unbounded, so that largest values have no limit: the order measured on the mesh
// (unbounded_order.cpp) and, where that is too coarse, the order of corners, known from their angles.
//
// Near a corner of the angle w the stresses go like r^(l-1), l the least root of (Williams 1952)
//
//   sin^2 l w = l^2 sin^2 w                                           both sides free
//   sin^2 l w = (l/kappa)^2 sin^2 w                                   both held
//   sin^2 l w = (kappa+1)^2/(4 kappa) - l^2 sin^2 w / kappa           one held, one free
//
// kappa = 3 - 4 nu, in plane stress (3 - nu)/(1 + nu). A side that is held along its normal alone is a plane
// of symmetry: the corner is half of one of twice the angle.
#pragma once

#include "solver/model.h"
#include "solver/state.h"

namespace mortier {

/// a, where stresses near a place are unbounded like r^-a, so that the energy in discs around it goes like
/// r^(2 - 2a) in one of the bodies. 0 where they seem bounded, and where meshes are too coarse.
double unboundedOrder(const Model& model, const State& state, const Point& place);

/// Of a side of a corner.
enum class SideSupport { free, sliding, held };

/// 1 - l; 0 where stresses are bounded.
double orderOfCorner(double angle, SideSupport first, SideSupport second, double kappa);

/// The same of the corner or the end of a support of a body next to a place, if the stress grows towards it;
/// 0 where there is none.
double cornerOrder(const Body& body, const Matrix& stress, const Point& place);

/// Whether contact that presses ends next to a place at a corner of one body, while the other one continues:
/// its pressure may be unbounded.
bool contactEndsAt(const Model& model, const State& state, const Point& place);

}  // namespace mortier
