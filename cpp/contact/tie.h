// A tie: two sides of two bodies that move as one, on meshes that need not match. The jump of the
// displacements vanishes in the mean,
//
//   int chi_i (u1(x1) - u2(x1)) ds = 0        for every row function chi_i of the nonmortar side,
//
// or at the nonmortar nodes (interpolation). x1 faces x2 on the mortar side as in contact
// (common_refinement.h, surface.h). Where they are apart, as nonmatching meshes of one curve are, the
// displacement of the mortar element behind x2 is extended to x1,
//
//   u2(x1) = u2(x2) + grad u2(x2) (x1 - x2),
//
// so that rigid motions of both bodies and displacements that are linear have no jump, whatever the distance,
// and the forces of a row balance in force and moment. The drawn distance is kept.
//
// A node has a row for each axis, or for each direction of the frame of its support where that is turned.
// Along a direction in which the node is held the row function goes to neighbours with rows, and so it does
// at nodes where another tie has rows, and at corners, where tractions jump: there are no more rows than
// motions. Interpolation has no such row.
#pragma once

#include <array>
#include <functional>
#include <vector>

#include "contact/interface.h"

namespace mortier {

struct TieOptions {
  /// Whether the motion of a node along a direction is prescribed; none is where empty.
  using Held = std::function<bool(int node, const SpacePoint& direction)>;
  Held nonmortarHeld = {};
  Held mortarHeld = {};
  std::function<bool(int node)> taken = {};  ///< whether another tie has rows at a nonmortar node
  /// Directions of the rows of a node, as rows; the axes where empty.
  std::function<Eigen::Matrix3d(int node)> frame = {};
  bool axisymmetric = false;  ///< whether integrals are over the whole ring
};

/// Points of the common refinement of both sides.
struct TiePoints {
  std::array<Eigen::SparseMatrix<double>, 2> traces;  ///< points x nodes of both bodies: of u1(x1) - u2(x1)
  std::vector<std::array<int, 2>> elements;           ///< behind the sides, of both bodies
  Vector weights;                                     ///< ds [m], in space [m^2], of rings [m^2]
  Vector sizes;                                       ///< an edge of the nonmortar side [m]

  /// Dimensions x points [m]. \param uNonmortar, uMortar  by dofs
  [[nodiscard]] Matrix jump(const Vector& uNonmortar, const Vector& uMortar, int dimension) const;
};

class Tie {
 public:
  /// \throws InputError when the sides do not face each other
  Tie(const ContactPair& pair, const ContactMesh& nonmortarMesh, const ContactMesh& mortarMesh,
      const TieOptions& options = {});
  /// The same in space.
  Tie(const ContactPair& pair, const SpaceContactMesh& nonmortarMesh, const SpaceContactMesh& mortarMesh,
      const TieOptions& options = {});

  [[nodiscard]] const ContactPair& pair() const { return pair_; }
  /// 2 or 3: columns are dofs dimension() node + component.
  [[nodiscard]] int dimension() const { return dimension_; }
  [[nodiscard]] int rows() const { return static_cast<int>(C1_.rows()); }
  [[nodiscard]] const ConstraintRows& C1() const { return C1_; }  ///< on the nonmortar body
  [[nodiscard]] const ConstraintRows& C2() const { return C2_; }  ///< on the mortar body
  /// Nonmortar nodes that have rows, ascending.
  [[nodiscard]] const std::vector<int>& nonmortarNodes() const { return nodes_; }
  /// Share of the nonmortar side that faces the other.
  [[nodiscard]] double overlap() const { return overlap_; }
  /// The largest drawn distance of points that face each other [m].
  [[nodiscard]] double distance() const { return distance_; }

  [[nodiscard]] const TiePoints& points() const { return points_; }

  /// C u: the jump by rows; displacements by dofs of the two bodies [m].
  [[nodiscard]] Vector jump(const Vector& uNonmortar, const Vector& uMortar) const {
    return C1_ * uNonmortar + C2_ * uMortar;
  }
  /// f -= C' p on both bodies' nodal forces [N/m].
  void subtractForces(const Vector& p, Vector& fNonmortar, Vector& fMortar) const {
    fNonmortar -= C1_.transpose() * p;
    fMortar -= C2_.transpose() * p;
  }

 private:
  struct Jumps;
  void setRows(const Jumps& jumps, const TieOptions& options, int nodes1, int nodes2);

  ContactPair pair_;
  int dimension_ = 2;
  ConstraintRows C1_, C2_;
  std::vector<int> nodes_;
  TiePoints points_;
  double overlap_ = 0;
  double distance_ = 0;
};

}  // namespace mortier
