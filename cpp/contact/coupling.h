// The coupling of a part of the nonmortar line with the mortar line: one row of C per trace node that has a
// condition.
//
// x1(s) faces the mortar point x2(s) along the direction n(s) (common_refinement.h). With the jump
// j(s) = n . (u1(x1) - u2(x2)), traces sum phi_k u1_k and sum psi_l u2_l of the elements,
// and row functions chi_i,
//
//   interpolation  (C u)_i = j(s_i)
//   mortar         C u = Phi^-1 int chi j ds,   Phi_ij = int chi_i chi_j ds:   the L2 projection of the jump
//   weighted       C u = w^-1 int chi j ds,   w_i = int chi_i ds:          its means
//
// so that the nodal forces of the pressure sum pi_i chi_i are Phi pi, or w pi; w is Phi lumped. In the
// field's words C u = Phi^-1 (D u1 - M u2), D_ik = int chi_i n phi_k the matrix of the nonmortar side and
// M_il = int chi_i n psi_l that of the mortar side (the note writes D for the latter, and M for Phi). chi are
// the shape functions phi; with `weighted` they are the hat functions of the vertices, whatever the degree,
// and p >= 0 says that the pressure is so at every point.
//
// Where the nonmortar side is finer than the mortar side and less compliant (h the distances of nodes, E the
// stiffness: h1/E1 < h2/E2), neither trace follows pressures that alternate from node to node: the inf-sup
// constant of the nodal pressures is lost, and they alternate. Stabilised conditions yield there as a finer
// mortar mesh would (pressure_compliance.h), and those at ends act at the end (end_rows.h).
//
// The distance g0 is taken by the same rows. With mortar it is moved up where the projection of a convex
// distance would be below the least one where a row function is not 0 (coupling.cpp).
//
// A corner or an end of a line that touches the other one (CornerContact) is one point: the row of its vertex
// becomes, in the part of its weight, the jump at that point.
//
// Integrals are Lobatto's on the common refinement, exact where the part is straight (quadrature on the
// elements of one side would fail the patch test). Where only one vertex of an element has a row (the mortar
// side ends inside the element, or the other vertex is merged into it), its chi is extended by 1: constants
// are still reproduced, and Phi stays well conditioned however small the piece.
//
// The projection is taken of the difference from the motion of the row's own node along its own n_i,
//
//   Phi^-1 D u1 = n . u1 at the nodes + Phi^-1 int chi (n . u1 - sum chi_i n_i . u1_i) ds,
//
// where the second term is zero on straight parts and sparse everywhere: of Phi^-1 D and Phi^-1 M only the
// latter is dense, and its entries decay by a factor of about four a node with the distance from the node
// that is faced.
//
// Whatever the rule, each of its points adds a pair of opposite forces along the line through x1 and x2, and
// shape functions reproduce both places: every row balances in force and moment (docs/theory.md).
//
// Example (tests/unit/coupling_test.cpp): nonmortar nodes 0, 1/2, 1 and mortar nodes 0, 1/3, 1 give
//   D = Phi = 1/12 [2 1 0; 1 4 1; 0 1 2],   M = 1/432 [56 51 1; 16 138 62; 0 27 81],
//   D^-1 M = 1/36 [30 9 -3; -4 33 7; 2 -3 37],   w^-1 M = 1/108 [56 51 1; 8 69 31; 0 27 81].
// (Hild 2000; Bernardi, Maday, Patera 1994; curves: Yang, Laursen, Meng 2005.)
#pragma once

#include <vector>

#include "base/sparse.h"
#include "base/types.h"
#include "contact/common_refinement.h"
#include "contact/pressure_compliance.h"

namespace mortier {

enum class CouplingKind { interpolation, mortar, weighted };

struct Coupling {
  std::vector<int> nodes;            ///< trace nodes of the part with a row, along the line (ElementLine)
  Eigen::SparseMatrix<double> mass;  ///< Phi, or w as a diagonal, rows x rows [m]
  Eigen::SparseMatrix<double> C1;    ///< rows x 2 (trace nodes of the part): columns 2 node + component
  Eigen::SparseMatrix<double> C2;    ///< rows x 2 (trace nodes of the mortar line)
  Vector distance;                   ///< g0, by rows [m]
  Eigen::SparseMatrix<double> N;     ///< rows x trace nodes: g0 of a distance that is given at the nodes
  Vector lengths;                    ///< int chi ds, by rows [m]
  PressureCompliance yielding;       ///< of `mortar` and `weighted`
  Eigen::SparseMatrix<double> ends;  ///< T of end_rows.h where stabilised, else empty
};

/// What the rows of `mortar` and `weighted` get so that pressures do not alternate and bodies rest on ends.
struct Stabilisation {
  bool applied = false;
  double mortarCompliance = 0;  ///< 1/E2 of pressure_compliance.h [1/Pa]
  std::vector<char> merged;     ///< vertices of the part without a row of their own
  std::vector<char> symmetric;  ///< ends of the part that lie on an axis of symmetry
};

/// Whether rows are weighted means, with a mass that is diagonal.
inline bool hasMeans(CouplingKind kind) {
  return kind == CouplingKind::weighted;
}

/// The degree of the row functions on a line whose trace has a degree.
inline int rowDegree(CouplingKind kind, int traceDegree) {
  return hasMeans(kind) ? 1 : traceDegree;
}

/// \param distance  of the bodies, where x1(s) faces
/// \param merged  vertices of the part without a row of their own (empty: none). No rows when no vertex lies
/// where the part faces the mortar line.
/// \param axisymmetric  whether the line turns about the axis x = 0: integrals are over the whole surface
/// then, ds 2 pi r of the nonmortar line, and the mass is in [m^2]
/// \param only  the trace nodes that may have a row, whether or not they face the mortar line themselves;
/// empty: those that do
Coupling couple(CouplingKind kind, const CommonRefinement& refinement,
                const DistanceAt& distance = distanceOfCurves, const std::vector<char>& merged = {},
                bool axisymmetric = false, const std::vector<char>& only = {},
                const Stabilisation& stabilisation = {});

}  // namespace mortier
