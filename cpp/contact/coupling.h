// How the nonmortar nodes see the mortar side: rows of C, one per nonmortar node that faces it.
//
// On a straight part, with the traces of both sides on one line and n constant, C u = (B u1 - A u2) . n,
//
//   interpolation  A = I_h:     values of the mortar trace at the nonmortar nodes,   B = 1
//   mortar         A = M^-1 D,  B = M^-1 N:  L2 projections on the span of the row functions chi,
//                               M_ij = int chi_i chi_j,  N_ij = int chi_i phi_j,  D_ij = int chi_i psi_j,
//
// phi, psi the hat functions of the two traces, all integrals exact on the common refinement (quadrature on
// the elements of one side would fail the patch test). chi = phi, and so B = 1, wherever both nodes of an
// element have a row. Where only one has (the mortar side ends inside the element, or the other node is
// merged into it), the one's chi goes on as 1: constants are still reproduced, and M stays well conditioned
// however small the piece.
//
// On a curve, with x1(s) seeing the mortar point x2(s) along the direction n(s) (facing_line.h),
//
//   interpolation  (C u)_i = n(s_i) . (u1(x_i) - u2(x2(s_i)))
//   mortar         C u = M^-1 int chi n . (u1(x1(s)) - u2(x2(s))) ds
//
// with Gauss points. Whatever the rule, each term is a pair of opposite forces along the line through x1 and
// x2, and the hat functions reproduce both places: every row balances in force and moment (docs/theory.md).
//
// Example (tests/unit/coupling_test.cpp): nonmortar nodes 0, 1/2, 1 and mortar nodes 0, 1/3, 1 give
//   M = 1/12 [2 1 0; 1 4 1; 0 1 2],   D = 1/432 [56 51 1; 16 138 62; 0 27 81],
//   A = M^-1 D = 1/36 [30 9 -3; -4 33 7; 2 -3 37].
// (Hild 2000; Bernardi, Maday, Patera 1994; curves: Yang, Laursen, Meng 2005.)
#pragma once

#include <Eigen/SparseCore>
#include <vector>

#include "base/types.h"
#include "contact/facing_line.h"

namespace mortier {

enum class CouplingKind { interpolation, mortar };

struct Coupling {
  std::vector<int> nodes;         ///< nonmortar trace nodes with a row, ascending
  Eigen::SparseMatrix<double> M;  ///< mass of the row functions [m]
  Eigen::SparseMatrix<double> D;  ///< rows x mortar nodes [m]
  Matrix A;                       ///< rows x mortar nodes; rows sum to one
  Matrix B;                       ///< rows x nonmortar nodes; rows sum to one
};

/// \param nonmortar, mortar  traces on one line [m]
/// \param merged  trace nodes without a row of their own (empty: none). No rows when no node lies within the
/// overlap.
Coupling couple(CouplingKind kind, const Trace& nonmortar, const Trace& mortar,
                const std::vector<char>& merged = {});

/// The rows of one part of the nonmortar line.
struct PartCoupling {
  std::vector<int> nodes;          ///< nodes of the part with a row, ascending
  Eigen::SparseMatrix<double> M;   ///< mass of the row functions, rows x rows [m]
  Eigen::SparseMatrix<double> C1;  ///< rows x 2 (nodes of the part): columns 2 node + component
  Eigen::SparseMatrix<double> C2;  ///< rows x 2 (nodes of the facing line)
  Vector bulge;  ///< by which the curves are nearer to each other than the polygons, per row [m]
};

/// The same for a part of the nonmortar line and what it faces: C1 and C2 take displacements by components.
PartCoupling couple(CouplingKind kind, const SmoothPart& part, const FacingLine& mortar,
                    const std::vector<char>& merged = {});

}  // namespace mortier
