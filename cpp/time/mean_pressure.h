// The mean of the contact pressure over a part of a line. The force p_i of a row of C is spread over its row
// function: with the weight w of the part (mesh/line_part.h)
//
//   mean = sum of p_i (integral of w chi_i / integral of chi_i) / (integral of w).
#pragma once

#include <vector>

#include "mesh/line_part.h"
#include "solver/model.h"

namespace mortier {

/// Factors of the forces, by interfaces and rows [1/m], or of bodies that turn about an axis [1/m^2].
/// \param body,label  the side of contact that the part is of
std::vector<Vector> meanPressureShares(const Model& model, int body, int label, const LinePart& part);
/// The same in space, of the whole side: 1 over its area [1/m^2].
std::vector<Vector> meanPressureShares(const Model& model, int body, int label);

}  // namespace mortier
