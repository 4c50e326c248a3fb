// Nodal forces that are out of balance next to a contact line, taken up by stresses in a few rings of
// triangles around them: an elastic solution of the strip, whose inner rim is free. Forces and couples on it
// balance each other, or its supports hold it, where pressures have the force and the couple of the nodal
// forces (pressures.h).
#pragma once

#include <optional>
#include <vector>

#include "bound/side_tractions.h"

namespace mortier {

/// \param moduli  by triangles, on (p, q, r) of strains [Pa]
/// \param left  nodal forces less those of the stresses (dofs) [N/m]
/// \param size  what forces are measured against [N/m]
/// \param stress  by triangles, to be balanced [Pa]
/// \returns the energy of what it adds in the rings that are far from these forces [J/m]; none where stresses
/// could not be balanced: neither is changed then
std::optional<double> balanceStrip(const Body& body, const Sides& sides,
                                   const std::vector<Eigen::Matrix3d>& moduli, double size, Vector& left,
                                   std::vector<Stress>& stress);

}  // namespace mortier
