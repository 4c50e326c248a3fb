// A contact interface between two meshes, discretised: the rows of C, the gap, and what is measured on
// Gamma_C.
//
//   [C u]_i = (u1_i - sum_j A_ij u2_j) . n,      g = C u - g0 <= 0,   p >= 0,   p g = 0
//
// i runs over the nonmortar contact nodes, j over the mortar nodes, n is the outward normal of the nonmortar
// body, A comes from the coupling (interpolation or projection), g0 is the distance of the bodies as meshed.
// The solver sees two sparse matrices and a vector only: C u = C1 u1 + C2 u2, and g0.
#pragma once

#include <Eigen/SparseCore>

#include "base/types.h"
#include "contact/coupling.h"
#include "mesh/boundary_line.h"

namespace mortier {

/// One side of an interface: a labelled boundary of a body.
struct ContactSide {
  int body = 0;
  int label = 0;
};

struct ContactPair {
  ContactSide nonmortar;
  ContactSide mortar;
  CouplingKind coupling = CouplingKind::mortar;
};

/// Rows of C on one body: conditions x dofs (2 vertex + component), without entries that are zero.
using ConstraintRows = Eigen::SparseMatrix<double>;

class ContactInterface {
 public:
  /// \throws InputError when a line is not straight, or the lines do not face each other, overlap nowhere or
  /// penetrate.
  ContactInterface(const ContactPair& pair, const TriangleMesh& nonmortarMesh,
                   const TriangleMesh& mortarMesh);

  [[nodiscard]] const ContactPair& pair() const { return pair_; }
  /// Vertex numbers of the nonmortar nodes that carry a condition, along the line; one row of C each.
  [[nodiscard]] const std::vector<int>& nonmortarNodes() const { return nonmortarNodes_; }
  /// Vertex numbers of the mortar nodes; one column of coupling().A each.
  [[nodiscard]] const std::vector<int>& mortarNodes() const { return mortarNodes_; }
  [[nodiscard]] const Coupling& coupling() const { return coupling_; }
  /// Outward normal of the nonmortar body.
  [[nodiscard]] const Point& normal() const { return normal_; }
  [[nodiscard]] const ConstraintRows& C1() const { return C1_; }             ///< on the nonmortar body
  [[nodiscard]] const ConstraintRows& C2() const { return C2_; }             ///< on the mortar body
  [[nodiscard]] const Vector& initialDistance() const { return distance_; }  ///< g0 [m]
  /// Share of the shorter line that faces the other.
  [[nodiscard]] double overlap() const { return overlap_; }
  [[nodiscard]] int rows() const { return static_cast<int>(distance_.size()); }

  /// g = C u - g0; displacements by dofs of the two bodies [m].
  [[nodiscard]] Vector gap(const Vector& uNonmortar, const Vector& uMortar) const;
  /// f -= C' p on both bodies' nodal forces [N/m].
  void subtractForces(const Vector& p, Vector& fNonmortar, Vector& fMortar) const;
  /// M^-1 p: nodal values of the contact pressure [Pa] for nodal forces p [N/m].
  [[nodiscard]] Vector contactPressure(const Vector& p) const;
  /// Integral over Gamma_C of (u1.n1 + u2.n2 - distance)_+, exact for the piecewise linear traces [m^2].
  [[nodiscard]] double interpenetration(const Vector& uNonmortar, const Vector& uMortar) const;

 private:
  ContactPair pair_;
  Point normal_;
  Coupling coupling_;
  std::vector<int> nonmortarNodes_;
  std::vector<int> mortarNodes_;
  ConstraintRows C1_;
  ConstraintRows C2_;
  Vector distance_;
  double overlap_ = 0;
  // The whole traces, for integrals over Gamma_C.
  BoundaryLine nonmortarLine_;
  BoundaryLine mortarLine_;
  Trace nonmortarTrace_;
  Trace mortarTrace_;
};

}  // namespace mortier
