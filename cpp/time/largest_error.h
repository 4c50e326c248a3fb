// How far largest values and what is in contact are off because of the meshes: of largest values the
// difference of the recovered stress, of the length of contact half an element at each end, of its area half
// an element along its border.
#pragma once

#include "time/quantity_error.h"

namespace mortier {

/// Of a largest pressure or von Mises stress. Its order is that of unbounded stresses at the place, as
/// measured.
QuantityError errorOfLargest(const Quantity& quantity, const Model& model, CurrentMeshError& error);

/// Of a length or an area of contact.
double errorOfContactSize(const Quantity& quantity, const Model& model, const State& state);

}  // namespace mortier
