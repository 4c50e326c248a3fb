// The values that a step report gives of a state.
#pragma once

#include "base/parallel.h"
#include "contact/sliding.h"
#include "solver/iterate.h"
#include "solver/model.h"
#include "solver/state.h"
#include "time/report.h"

namespace mortier {

/// Fills what `report` says of the state, from penetration to viscoplastic share.
void measure(const Model& model, const State& state, Threads& threads, StepReport& report);

/// Raises the peaks of a run to those of a step.
void raise(Peaks& peaks, const StepReport& report);

/// How far the bodies of an interface have slid along each other.
Sliding slidingOf(const Model& model, const State& state, size_t interface);

/// The largest strain of any triangle of a body, and its rotation, of the displacements of the vertices
/// [-, rad].
struct Deformation {
  double strain = 0, rotation = 0;
};
Deformation deformationOf(const Body& body, const Vector& displacement);

/// Resultant of nodal contact forces on the nonmortar body [N/m].
SpacePoint resultant(const Model& model, const State& state, size_t interface);

/// The moment that the forces of friction on both bodies leave: t times the distance across which they act,
/// as meshed, of an interface with friction and not around an axis; about z in the plane [N].
SpacePoint frictionCouple(const Model& model, const State& state, size_t interface);

/// Counts how the active sets changed in a step.
void compareActive(const ActiveSets& before, const ActiveSets& after, StepReport& report);

/// The larger of each residual.
Certificate worse(const Certificate& a, const Certificate& b);

}  // namespace mortier
