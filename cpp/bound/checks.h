// Checks of the conditions of an error bound on the computed fields, independent of their construction:
// stresses in equilibrium in every part of every triangle and with the loads, the same pressure and no shear
// on both sides of a contact line, no negative pressure, no penetration.
#pragma once

#include <array>
#include <string>
#include <vector>

#include "bound/matched_meshes.h"
#include "bound/side_tractions.h"

namespace mortier {

/// The remainder of the forces and couples of a triangle, of the divergence of its parts, or of a given
/// traction; and the largest moment of a side [N/m].
struct Imbalance {
  double worst = 0;
  double largest = 0;
};

/// \param forces  by triangles  \param known  tractions by sides; those inside are not read
Imbalance imbalanceOf(const TriangleMesh& mesh, const Sides& sides, const SideMoments& moments,
                      const std::vector<BodyLoad>& forces, const std::vector<KnownTraction>& known);

/// How far the moments of the tractions on both sides of a piece of a contact line are from those of a
/// pressure: `above` on the body whose outward normal is that of the piece [N/m].
double mismatchOf(const MatchedPiece& piece, const std::array<double, 2>& pressure,
                  const std::array<Point, 2>& above, const std::array<Point, 2>& below);

/// The least gap at a vertex of a contact line over the largest displacement or distance there is [-].
double leastGapOf(const Model& model, const std::vector<MatchedPiece>& pieces,
                  const std::vector<Vector>& displacements);

/// The ingredients of a bound.
struct Strictness {
  double imbalance = 0;      ///< over the largest moment [-]
  double mismatch = 0;       ///< the same
  double leastPressure = 0;  ///< [Pa]
  double leastGap = 0;       ///< [-]
  /// Which of them is not met, to rounding; empty where all are.
  [[nodiscard]] std::string broken() const;
};

}  // namespace mortier
