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
//
// A side may be tied to a rigid body without a surface, the motion of a point (TieKind). A layer of stiffness
// k [N/m^3] between the sides, or a spring, leaves the jump that its traction makes, C u = S l with
//
//   S_ij = 1/k int chi_i chi_j ds.
//
// A third body, a rigid one without a surface, may move the sides apart: the jump is then u1 - u2 - u3, and
// what acts on that body is what pulls the sides together (a bolt that is tightened).
#pragma once

#include <array>
#include <functional>
#include <map>
#include <optional>
#include <utility>
#include <vector>

#include "contact/interface.h"

namespace mortier {

/// What of the nonmortar side follows the other one.
enum class TieKind {
  surface,      ///< its displacement, by row functions or at nodes
  kinematic,    ///< each node follows a rigid body without a surface
  distributing  ///< the mean motion of its nodes does, each weighted with its part of the side
};

/// Values of shape functions by nodes.
using NodeValues = std::vector<std::pair<int, double>>;

/// A rigid body without a surface by its displacement at any place.
struct RigidTrace {
  int body = 0;
  int nodes = 0;
  std::function<NodeValues(const SpacePoint& place)> at;

  RigidTrace(int ofBody, const ContactMesh& mesh);
  RigidTrace(int ofBody, const SpaceContactMesh& mesh);
};

struct TieOptions {
  /// Whether the motion of a node along a direction is prescribed; none is where empty.
  using Held = std::function<bool(int node, const SpacePoint& direction)>;
  Held nonmortarHeld = {};
  Held mortarHeld = {};
  Held offsetHeld = {};
  TieKind kind = TieKind::surface;
  std::array<bool, 3> along{true, true, true};  ///< axes along which there are rows
  double stiffness = 0;                         ///< of a layer between the sides; 0: there is none [N/m^3]
  std::optional<RigidTrace> offset = {};        ///< the third body, ...
  bool offsetOfMortar = false;  ///< whose motion is that of the mortar side away from the nonmortar side
  std::function<bool(int node)> taken = {};  ///< whether another tie has rows at a nonmortar node
  /// Directions of the rows of a node, as rows; the axes where empty.
  std::function<Eigen::Matrix3d(int node)> frame = {};
  bool axisymmetric = false;  ///< whether integrals are over the whole ring
};

/// The rows of a tie on one of its bodies.
struct TieSide {
  int body = 0;
  ConstraintRows C = {};                    ///< rows x dofs
  Eigen::SparseMatrix<double> traces = {};  ///< points x nodes: of the jump
};

/// Points of the common refinement of both sides.
struct TiePoints {
  std::vector<std::array<int, 2>> elements;  ///< behind the sides, of both bodies
  Vector weights;                            ///< ds [m], in space [m^2], of rings [m^2]
  Vector sizes;                              ///< an edge of the nonmortar side [m]
  double layer = 0;                          ///< jump over traction of what is between the sides [m^3/N]
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
  [[nodiscard]] int rows() const { return static_cast<int>(sides_.front().C.rows()); }
  /// The nonmortar body, the mortar body and, where there is one, the third.
  [[nodiscard]] const std::vector<TieSide>& sides() const { return sides_; }
  /// Nonmortar nodes that have rows, ascending.
  [[nodiscard]] const std::vector<int>& nonmortarNodes() const { return nodes_; }
  /// Share of the nonmortar side that faces the other.
  [[nodiscard]] double overlap() const { return overlap_; }
  /// The largest drawn distance of points that face each other [m].
  [[nodiscard]] double distance() const { return distance_; }
  /// Of a kinematic tie, the nodes whose motions in some direction have no row, as both are prescribed, ...
  [[nodiscard]] const std::vector<int>& heldNodes() const { return heldNodes_; }
  /// ... and the jumps there [m]. \param u  displacements of all bodies, by dofs
  [[nodiscard]] Vector heldJump(const std::vector<Vector>& u) const;

  [[nodiscard]] const TiePoints& points() const { return points_; }
  /// u1 - u2 at the points along the axes that are tied, less what a layer allows under the forces l:
  /// dimensions x points [m].
  [[nodiscard]] Matrix jumpAtPoints(const std::vector<Vector>& u, const Vector& l) const;

  /// Whether there is a layer, or a spring.
  [[nodiscard]] bool elastic() const { return compliance_.nonZeros() > 0; }
  /// S [m^2/N], in space [m/N]; empty where all is rigid.
  [[nodiscard]] const Eigen::SparseMatrix<double>& compliance() const { return compliance_; }
  /// S l, by which the jump gives way to forces [m].
  [[nodiscard]] Vector yielded(const Vector& l) const {
    return elastic() ? Vector(compliance_ * l) : Vector::Zero(rows());
  }

  /// C u: the jump by rows [m]. \param u  displacements of all bodies, by dofs
  [[nodiscard]] Vector jump(const std::vector<Vector>& u) const;
  /// f -= C' l on all bodies' nodal forces [N/m].
  void subtractForces(const Vector& l, std::vector<Vector>& force) const;

 private:
  struct Jumps;
  /// None yet.
  template <class Contact>
  Jumps between(const Contact& nonmortar, int mortarNodes, const TieOptions& options);
  void setRows(const Jumps& jumps, const TieOptions& options);
  template <class Contact>
  void followPoint(const Contact& nonmortar, const RigidTrace& point, const TieOptions& options);
  void setMeanRows(const std::map<int, double>& parts, const Jumps& jumps, const RigidTrace& point,
                   const TieOptions& options);
  /// \param functions  row functions as vectors times the weights: rows x (dimensions points)
  void setCompliance(double stiffness, const Eigen::SparseMatrix<double>& functions, const Vector& weights);

  ContactPair pair_;
  int dimension_ = 2;
  std::vector<TieSide> sides_;
  std::vector<int> nodesOfSides_;  ///< of the bodies
  std::vector<int> nodes_;
  std::vector<int> heldNodes_;
  std::vector<ConstraintRows> heldRows_;  ///< by sides
  TiePoints points_;
  std::array<bool, 3> along_{true, true, true};
  Eigen::SparseMatrix<double> layer_;  ///< what forces of rows move the points by: rows x (dimensions points)
  Eigen::SparseMatrix<double> compliance_;
  double overlap_ = 0;
  double distance_ = 0;
};

}  // namespace mortier
