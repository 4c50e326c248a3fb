// What the conditions of contact yield by where the mortar trace is coarser than the rows.
//
// Pressures that alternate within an element of the mortar trace do not move the mortar side, though a mesh
// as fine as the rows would yield to them: nodal pressures would alternate. The condition of contact is
//
//   g = C u - S p - g0 <= 0,   p >= 0,   p g = 0,
//   p'S p = c/E2 sum_(i<j) k_ij l_i l_j (pi_i - pi_j)^2,   k_ij = max(0, 1 - |s_i - s_j|/h2),
//
// with pi = p/w the pressures at the nodes, w the weights and l the lengths of the rows, h2 the distance of
// the nodes of the mortar trace there and E2 the modulus of the mortar body in a half-plane. With c = 0.4 a
// force on one node gets about the compliance that the mortar mesh lacks. S is symmetric and nonnegative,
// without effect on uniform pressures, of second order in h2 on smooth ones, continuous in the places of all
// nodes, and zero where the mortar side is as fine as the rows or is held.
//
// What still varies within h2 is no pressure of the bodies. Pressures are given by the linear functions that
// fit those within h2 best, with the weights k_ij l_j: linear pressures stay as they are. On a surface they
// are fitted within the metric H2 + 3/2 H1, H1 of the vertices of the nonmortar side: on tetrahedra of any
// shape the force on a node follows these as well, by 20 % of the pressure for linear ones with 10 on a half
// width, though displacements are right.
#pragma once

#include <map>
#include <vector>

#include "base/sparse.h"
#include "contact/common_refinement.h"
#include "contact/surface.h"

namespace mortier {

struct PressureCompliance {
  Eigen::SparseMatrix<double> S;      ///< rows x rows [m^2/N]
  Eigen::SparseMatrix<double> means;  ///< of nodal pressures, rows x rows
  Vector spacing;                     ///< h2 by rows [m]
};

/// \param nodes  trace nodes of the part that have a row (ElementLine)
/// \param weights  integrals of the row functions [m], over the whole surface [m^2]
/// \param lengths  the same along the line [m]
/// \param mirrors  abscissae of ends on axes of symmetry: sums include the mirror images of the nodes
/// \param compliance  1/E2, 0 where the mortar side is held [1/Pa]
PressureCompliance pressureCompliance(const CommonRefinement& refinement, const std::vector<int>& nodes,
                                      const Vector& weights, const Vector& lengths,
                                      const std::vector<double>& mirrors, double compliance);

/// The distances h2 of the nodes of a surface, by direction: tensors H with e . H^-1 e = 1 for the edges e
/// between nodes; at vertices the means of the triangles around, linear between [m^2].
class SurfaceSpacing {
 public:
  explicit SurfaceSpacing(const ContactSurface& surface);
  /// \returns zero where a ray has met nothing
  [[nodiscard]] Eigen::Matrix3d at(const RayHit& hit) const;
  /// \returns that of the vertices alone at one of them
  [[nodiscard]] Eigen::Matrix3d ofVertices(int node) const;

 private:
  const ContactSurface& surface_;
  std::map<int, Eigen::Matrix3d> atVertices_;
};

/// A row of a surface.
struct SurfaceRow {
  SpacePoint place{0, 0, 0};  ///< of its vertex [m]
  SpacePoint normal{0, 0, 0};
  int part = 0;  ///< rows of one smooth part are compared
  /// Of the mortar surface there, 0 where it is held.
  Eigen::Matrix3d spacing = Eigen::Matrix3d::Zero();
  /// Within which pressures are fitted.
  Eigen::Matrix3d fitted = Eigen::Matrix3d::Zero();
  /// Components along the surface.
  [[nodiscard]] Eigen::Vector2d alongIt(const SpacePoint& way) const;
};

/// The same of a surface, with h2 in the direction from row to row:
///   p'S p = 3/pi c/E2 sum_(i<j) k_ij A_i A_j/h2 (pi_i - pi_j)^2.
/// \param areas  integrals of the row functions [m^2]
PressureCompliance pressureCompliance(const std::vector<SurfaceRow>& rows, const Vector& areas,
                                      double compliance);

/// Nodal pressures by rows as the linear functions that fit those within `fitted` best.
Eigen::SparseMatrix<double> linearFits(const std::vector<SurfaceRow>& rows, const Vector& areas);

}  // namespace mortier
