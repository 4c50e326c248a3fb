// The contact pressure p^ of a bound: nowhere negative, with the nodal forces of the finite elements,
//
//   p^ = sum (p_i / integral of chi_i) chi_i,      chi_i the row functions of C,
//
// zero where nothing presses and constant where the forces are those of a constant pressure. A row of which
// little faces the mortar side is taken together with its neighbour, as its force would press on a point.
#pragma once

#include <array>
#include <vector>

#include "bound/loaded_body.h"
#include "bound/matched_meshes.h"

namespace mortier {

/// Coefficients of p^ by interfaces and rows [Pa].
std::vector<Vector> spreadPressures(const Model& model, const State& state, const MatchedMeshes& meshes);
/// The same of any nodal forces by interfaces and rows [N/m].
std::vector<Vector> spreadForces(const Model& model, const std::vector<Vector>& forces,
                                 const MatchedMeshes& meshes);

/// p^ at begin and end of a piece.
std::array<double, 2> pressureOn(const MatchedPiece& piece, const std::vector<Vector>& spread);

/// Moments of a linear function by its values at both ends.
std::array<double, 2> momentsOfLinear(const std::array<double, 2>& values, double length);

/// Loads both bodies by a linear pressure of these values at begin and end.
void press(const MatchedPiece& piece, const Model& model, const std::array<double, 2>& pressure,
           std::vector<LoadedBody>& bodies);

/// Changes the coefficients by factors 1 + a + b x, two for each interface, such that bodies that contact
/// alone holds are in equilibrium. \returns false where that cannot be with pressures that are nowhere
/// negative
bool balancePressures(const Model& model, const MatchedMeshes& meshes, const std::vector<LoadedBody>& bodies,
                      std::vector<Vector>& spread);
/// The same by adding (a + b x) times other coefficients, whatever the sign. \returns false where it cannot
/// be
bool balanceBy(const std::vector<Vector>& weights, const Model& model, const MatchedMeshes& meshes,
               const std::vector<LoadedBody>& bodies, std::vector<Vector>& spread);

}  // namespace mortier
