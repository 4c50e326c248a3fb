// How the nonmortar nodes see the mortar trace: A, with one row per nonmortar node that faces the mortar
// side.
//
//   interpolation  A = I_h:     values of the mortar trace at the nonmortar nodes
//   mortar         A = M^-1 D:  its L2 projection on the nonmortar trace space,
//                               M_ij = int phi_i phi_j,  D_ij = int phi_i psi_j,
//                               both exact on the common refinement (quadrature on the elements of one side
//                               would fail the patch test)
//
// Where the mortar side ends inside a nonmortar element, the hat function of the element's inner node goes on
// as 1 to that end: constants are still reproduced, and M stays well conditioned however small the piece.
//
// Example (tests/unit/coupling_test.cpp): nonmortar nodes 0, 1/2, 1 and mortar nodes 0, 1/3, 1 give
//   M = 1/12 [2 1 0; 1 4 1; 0 1 2],   D = 1/432 [56 51 1; 16 138 62; 0 27 81],
//   A = M^-1 D = 1/36 [30 9 -3; -4 33 7; 2 -3 37].
// (Hild 2000; Bernardi, Maday, Patera 1994.)
#pragma once

#include <Eigen/SparseCore>
#include <vector>

#include "base/types.h"
#include "contact/segments.h"

namespace mortier {

enum class CouplingKind { interpolation, mortar };

struct Coupling {
  std::vector<int> nodes;         ///< nonmortar trace nodes with a row, ascending: those within the overlap
  Eigen::SparseMatrix<double> M;  ///< mass of their hat functions [m]
  Eigen::SparseMatrix<double> D;  ///< rows x mortar nodes [m]
  Matrix A;                       ///< rows x mortar nodes; rows sum to one
};

/// No rows when no nonmortar node lies within the overlap.
Coupling couple(CouplingKind kind, const Trace& nonmortar, const Trace& mortar);

}  // namespace mortier
