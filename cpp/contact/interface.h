// A contact interface between two meshes, discretised: the rows of C, the gap, and what is measured on
// Gamma_C.
//
//   C u = C1 u1 + C2 u2,      g = C u - g0 <= 0,   p >= 0,   p g = 0
//
// One row per nonmortar node (vertex, with linear row functions) that faces the mortar side (one per adjacent
// part at a corner), along the direction of contact there: coupling.h, common_refinement.h. g0 is the
// distance along it of the curves that the two lines stand for (arcs.cpp), of the lines as meshed where these
// are not known. The solver has the two sparse matrices and g0, nothing of geometry.
//
// A nonmortar node at an end of Gamma_C whose normal motion is prescribed, while its neighbour's is not, has
// no row of its own: its row function goes to the neighbour, so that Dirichlet conditions may reach to the
// end of Gamma_C and there are not more conditions than nodes that can move. With interpolation the row is
// left out where the mortar side is held there too. Where the trace is quadratic and row functions are linear
// there are nodes enough.
#pragma once

#include <Eigen/SparseCore>
#include <array>
#include <functional>
#include <memory>
#include <utility>

#include "base/datum.h"
#include "base/types.h"
#include "contact/coupling.h"
#include "contact/penetration.h"
#include "mesh/boundary_line.h"
#include "mesh/tetrahedron_mesh.h"

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

/// What is made of the distance as meshed.
enum class InitialGap {
  asMeshed,  ///< it is kept; a penetration of up to a hundredth of the shorter line is a negative distance
  close,     ///< the bodies touch all along
  reject     ///< an error, unless they do
};

/// The bound of the nodal forces |t| along contact: coefficient p + limit times the length of line (the mass
/// of the row functions), or the area, that the node stands for. Without friction both are 0.
struct Friction {
  double coefficient = 0;  ///< mu, Coulomb's law [-]
  double limit = 0;        ///< Tresca's law: the shear stress at which surfaces slip, pressed or not [Pa]

  [[nodiscard]] bool any() const { return coefficient > 0 || limit > 0; }
};

struct InterfaceOptions {
  InitialGap initial = InitialGap::asMeshed;  ///< of no effect where `gap` is given
  Datum gap = {};                             ///< distance at a nonmortar node instead of that as meshed [m]
  /// Whether the motion of a vertex along a direction is prescribed; none is where empty.
  using Held = std::function<bool(int node, const SpacePoint& direction)>;
  Held nonmortarHeld = {};
  Held mortarHeld = {};
  /// In space: unit vectors along which the displacement of a node is zero at all times, as in planes of
  /// symmetry.
  using Fixed = std::function<std::vector<SpacePoint>(int node)>;
  Fixed nonmortarFixed = {};
  Fixed mortarFixed = {};
  Friction friction = {};
  bool axisymmetric = false;  ///< whether the bodies turn about the axis x = 0: forces are in [N] then
  double stiffness = 1;       ///< of the nonmortar over that of the mortar body: where rows follow
  /// Of the mortar body in a half-plane, 1/E or (1 - nu^2)/E, in space in a half-space, (1 - nu^2)/E; 0 where
  /// it is held [1/Pa].
  double mortarCompliance = 0;
  bool stabilised = false;  ///< whether conditions are (Stabilisation)
  bool follows = false;     ///< whether rows follow the bodies (follow()); not with a `gap`
};

/// Rows of C on one body: conditions x dofs (2 node + component), without entries that are zero. Stored by
/// rows: a product costs its entries, not the dofs of a body.
using ConstraintRows = Eigen::SparseMatrix<double, Eigen::RowMajor>;

/// A mesh and the nodes of displacements on it.
template <class Mesh, class Nodes>
struct MeshWithNodes {
  const Mesh& mesh;
  const Nodes& nodes;
};
using ContactMesh = MeshWithNodes<TriangleMesh, ElementNodes>;
using SpaceContactMesh = MeshWithNodes<TetrahedronMesh, SpaceNodes>;

/// A mortar body whose nodes are not moved by its displacements u, but by a function of them.
struct MortarMotion {
  Vector moved;                        ///< by dofs, at u_k [m]
  Eigen::SparseMatrix<double> change;  ///< its derivative there; the rows of the mortar line
};

struct ContactSurface;

class ContactInterface {
 public:
  /// \throws InputError when the lines do not face each other, overlap nowhere, or are not as far from each
  /// other as the options allow.
  ContactInterface(const ContactPair& pair, const ContactMesh& nonmortarMesh, const ContactMesh& mortarMesh,
                   const InterfaceOptions& options = {});
  /// Between two surfaces (space_interface.cpp). What is the line's in the plane is the surface's, lengths
  /// are areas. \throws InputError
  ContactInterface(const ContactPair& pair, const SpaceContactMesh& nonmortarMesh,
                   const SpaceContactMesh& mortarMesh, const InterfaceOptions& options = {});
  /// The first for linear displacements.
  ContactInterface(const ContactPair& pair, const TriangleMesh& nonmortarMesh, const TriangleMesh& mortarMesh,
                   const InterfaceOptions& options = {});

  /// Whether rows are those of bodies that displacements have moved, instead of the bodies as meshed. Then
  /// every nonmortar node that may ever face the mortar side has its row, which is empty where it does not.
  [[nodiscard]] bool follows() const { return lines_ != nullptr || surfaces_ != nullptr; }
  /// Makes the rows those of the bodies moved by u_k, and g0 such that C u - g0 is the gap linearised there:
  ///   g = C (u - u_k) - d(u_k).
  /// \param keepRows  only nodes that have a row now have one, and corners of lines keep their weights: at
  /// the ends of lines the set of rows is a discontinuous function of the displacements
  void follow(const Vector& uNonmortar, const Vector& uMortar, bool keepRows = false,
              const MortarMotion* mortar = nullptr);
  /// d(u_k), the distance of the bodies where rows have followed them; by rows [m]
  [[nodiscard]] const Vector& distanceHere() const { return distanceHere_; }
  /// Whether a row is not empty.
  [[nodiscard]] bool faces(int row) const { return faces_.empty() || faces_[row] != 0; }
  /// Where rows follow, all nodes of the nonmortar side.
  [[nodiscard]] const std::vector<int>& nonmortarLine() const { return nonmortarLine_; }

  /// 2 or 3: columns of C are dofs dimension() node + component.
  [[nodiscard]] int dimension() const { return dimension_; }
  [[nodiscard]] const ContactPair& pair() const { return pair_; }
  /// Numbers of the nonmortar nodes that carry a condition, along the line; one row of C each. A node at a
  /// corner comes twice.
  [[nodiscard]] const std::vector<int>& nonmortarNodes() const { return nonmortarNodes_; }
  /// Numbers of the nodes of the mortar line, the vertices first.
  [[nodiscard]] const std::vector<int>& mortarNodes() const { return mortarNodes_; }
  /// Direction of contact at the node of each row, out of the nonmortar body; z = 0 in the plane.
  [[nodiscard]] const std::vector<SpacePoint>& normals() const { return normals_; }
  [[nodiscard]] const ConstraintRows& C1() const { return C1_; }             ///< on the nonmortar body
  [[nodiscard]] const ConstraintRows& C2() const { return C2_; }             ///< on the mortar body
  [[nodiscard]] const Vector& initialDistance() const { return distance_; }  ///< g0 at t = 0 [m]
  /// Whether g0 changes in time.
  [[nodiscard]] bool distanceMoves() const { return given_ && given_.inTime; }
  /// g0 at a time [m].
  [[nodiscard]] Vector distance(double t) const;
  /// Whether a distance is given in place of that as meshed.
  [[nodiscard]] bool distanceIsGiven() const { return static_cast<bool>(given_); }
  /// That distance; empty where none is.
  [[nodiscard]] const Datum& given() const { return given_; }
  [[nodiscard]] const Friction& friction() const { return friction_; }
  /// Whether there is friction. Then every row i of C has slipComponents() rows for the slip T u, with the
  /// same weights. In the plane it is row i of T, along n turned by +90 degrees: the direction of the
  /// nonmortar line, with its body to the left. In space they are rows 2i and 2i + 1, along tangents().
  [[nodiscard]] bool hasFriction() const { return friction_.any(); }
  /// Directions of slip at a node: dimension() - 1.
  [[nodiscard]] int slipComponents() const { return dimension_ - 1; }
  /// How many rows T has; 0 without friction.
  [[nodiscard]] int slipRows() const { return static_cast<int>(T1_.rows()); }
  /// In space with friction: the directions of slip at the node of each row, normal to that of contact and to
  /// each other. Along those in which both sides are fixed rows are empty: there is no slip, and by symmetry
  /// no force.
  [[nodiscard]] const std::vector<std::array<SpacePoint, 2>>& tangents() const { return tangents_; }
  [[nodiscard]] const ConstraintRows& T1() const {
    return T1_;
  }  ///< on the nonmortar body; no rows if smooth
  [[nodiscard]] const ConstraintRows& T2() const { return T2_; }  ///< on the mortar body; no rows if smooth
  /// T u: by how much the nonmortar body has moved along contact over the mortar body [m].
  [[nodiscard]] Vector slip(const Vector& uNonmortar, const Vector& uMortar) const {
    return T1_ * uNonmortar + T2_ * uMortar;
  }
  /// Bounds of |t| by rows of C [N/m] at nodal forces p.
  [[nodiscard]] Vector frictionBound(const Vector& p) const;
  /// f -= T' t on both bodies' nodal forces [N/m]; t is what the nonmortar body exerts along the line.
  void subtractFriction(const Vector& t, Vector& fNonmortar, Vector& fMortar) const;
  /// Mass of the row functions, rows x rows [m], or over the whole surface [m^2]: nodal forces are the mass
  /// times the contact pressure, where rows are not those of ends (contact/end_rows.h).
  [[nodiscard]] const Eigen::SparseMatrix<double>& mass() const { return mass_; }
  /// S, by which the conditions yield to nodal forces: g = C u - S p - g0 (contact/pressure_compliance.h).
  [[nodiscard]] const Eigen::SparseMatrix<double>& compliance() const { return compliance_; }
  [[nodiscard]] bool stabilised() const { return stabilised_; }
  [[nodiscard]] bool yields() const { return compliance_.nonZeros() > 0; }
  void stopYielding() { compliance_.setZero(); }
  /// Distance of the mortar nodes at the rows; none where the mortar side is held [m].
  [[nodiscard]] const Vector& mortarSpacing() const { return mortarSpacing_; }
  [[nodiscard]] Vector yielded(const Vector& p) const { return compliance_ * p; }
  /// Held end nodes of the nonmortar line that have no condition: merged into their neighbours, or left out.
  [[nodiscard]] int heldEnds() const { return heldEnds_; }
  /// By how much the lines may be off the curves behind them where these are not known and the distance is
  /// that as meshed: the largest sagitta [m].
  [[nodiscard]] double sagitta() const { return sagitta_; }
  /// Of interpolation in space: by which part of the largest the nodal forces of a uniform pressure are off
  /// on the mortar side; 0 where they are exact [-].
  [[nodiscard]] double patchError() const { return patchError_; }
  /// The sharpest turn of a line whose nodes lie on a circle, but too far apart to stand for it; 0 where
  /// neither does [rad].
  [[nodiscard]] double polygonTurn() const { return polygonTurn_; }
  /// Share of the shorter line that faces the other.
  [[nodiscard]] double overlap() const { return overlap_; }
  [[nodiscard]] int rows() const { return static_cast<int>(distance_.size()); }
  /// Of the line, by rows: integrals of the row functions [m].
  [[nodiscard]] Vector lengths() const { return axisymmetric_ || follows() ? lengths_ : weights(); }
  /// Nodal forces of a pressure of 1 [m], or over the whole surface [m^2].
  [[nodiscard]] const Vector& weights() const { return weights_; }

  /// C u; displacements by dofs of the two bodies [m].
  [[nodiscard]] Vector jump(const Vector& uNonmortar, const Vector& uMortar) const {
    return C1_ * uNonmortar + C2_ * uMortar;
  }
  /// g = C u - g0(t) [m].
  [[nodiscard]] Vector gap(const Vector& uNonmortar, const Vector& uMortar, double t = 0) const;
  /// f -= C' p on both bodies' nodal forces [N/m].
  void subtractForces(const Vector& p, Vector& fNonmortar, Vector& fMortar) const;
  /// mass^-1 p: nodal values of the contact pressure [Pa] for nodal forces p [N/m], fitted over the elements
  /// of a mortar side that is coarser, in space of both sides.
  [[nodiscard]] Vector contactPressure(const Vector& p) const;
  /// The part of the largest nodal pressure by which nodal pressures change within elements of the mortar
  /// side beside what is linear there; ends of contact do not count [-].
  [[nodiscard]] double pressureRoughness(const Vector& p) const;
  /// Integral over Gamma_C of ((u1 - u2).n - distance)_+, exact where the nonmortar line is straight [m^2];
  /// in space by the midpoint rule on the common refinement [m^3].
  [[nodiscard]] double interpenetration(const Vector& uNonmortar, const Vector& uMortar, double t = 0) const;
  /// What nodal forces p [N/m] leave of the gap between the nodes: its square where they press, that of the
  /// overlap elsewhere.
  [[nodiscard]] std::vector<GapSquare> gapSquares(const Vector& p, const Vector& uNonmortar,
                                                  const Vector& uMortar, double t = 0) const;
  /// The common refinement of two surfaces: a point in the middle of each cell.
  struct SurfacePoints {
    std::array<Eigen::SparseMatrix<double>, 2> traces;  ///< points x nodes of both bodies
    Eigen::SparseMatrix<double> rows;                   ///< points x rows: the row functions
    std::vector<SpacePoint> normals;
    Vector areas;                 ///< of the cells [m^2]
    Vector distances;             ///< of the bodies at t = 0 [m]
    std::array<Vector, 2> sizes;  ///< of the triangles of both sides: an edge [m]

    /// u1 - u2 at the points: 3 x points [m].
    [[nodiscard]] Matrix jump(const Vector& uNonmortar, const Vector& uMortar) const;
  };
  [[nodiscard]] const SurfacePoints& surfacePoints() const { return points_; }
  /// Where the surfaces as meshed are nearest to each other: a point for each pair of triangles that face
  /// each other, without areas. None where the distance is given.
  [[nodiscard]] const SurfacePoints& nearestPoints() const { return nearest_; }
  /// Of the bodies at these points [m].
  [[nodiscard]] Vector pointDistances(double t) const;
  /// The common refinement of the two lines.
  [[nodiscard]] std::vector<RefinedPiece> pieces() const { return penetration_.pieces(); }

 private:
  [[nodiscard]] Vector nodalPressure(const Vector& p) const;
  /// Takes distances that are rounding for zero, and refuses those that the options do not allow.
  void settleDistance(InitialGap initial, double shorter, const std::string& names);
  /// What is given at a time at the nodes of the nonmortar side, by node.
  [[nodiscard]] Vector givenAt(double t) const;
  /// The same; empty where it does not change.
  [[nodiscard]] Vector nodalGap(double t) const { return distanceMoves() ? givenAt(t) : Vector(); }
  /// What an interface that follows is made of (follow.cpp).
  struct Lines;
  /// Matrices while they are put together.
  struct Entries;
  /// The same in space (follow_surfaces.cpp), and what is put together there.
  struct Surfaces;
  struct RefinedSurfaces;
  void drawLines(const BoundaryLine& nonmortar, const BoundaryLine& mortar, const InterfaceOptions& options);
  void setRows(const Entries& entries);
  void assemble(const std::vector<CommonRefinement>& facing, const ContactMesh& nonmortarMesh,
                const ContactMesh& mortarMesh, const InterfaceOptions& options);

  void findRows(RefinedSurfaces& surfaces, const InterfaceOptions& options);
  void assemble(RefinedSurfaces& surfaces, const InterfaceOptions& options);
  void drawSurfaces(ContactSurface nonmortar, ContactSurface mortar, const InterfaceOptions& options);
  void followLines(const Vector& uNonmortar, const Vector& uMortar, bool keepRows,
                   const MortarMotion* mortar);
  void followSurfaces(const Vector& uNonmortar, const Vector& uMortar, bool keepRows,
                      const MortarMotion* mortar);

  int dimension_ = 2;
  std::shared_ptr<const Lines> lines_;  ///< of an interface that follows
  std::shared_ptr<const Surfaces> surfaces_;
  Vector distanceHere_;
  std::vector<char> faces_;
  std::vector<ContactDirections> directions_;  ///< by nonmortar parts, where it follows
  std::vector<int> nonmortarLine_;
  ContactPair pair_;
  std::vector<int> nonmortarNodes_;
  std::vector<int> mortarNodes_;
  std::vector<SpacePoint> normals_;
  std::vector<std::array<SpacePoint, 2>> tangents_;
  ConstraintRows C1_;
  ConstraintRows C2_;
  Friction friction_;
  ConstraintRows T1_;
  ConstraintRows T2_;
  Eigen::SparseMatrix<double> mass_;
  Eigen::SparseMatrix<double> compliance_;
  Eigen::SparseMatrix<double> means_;
  Eigen::SparseMatrix<double> fits_;  ///< of pressures in results
  Vector weights_;
  bool stabilised_ = false;
  Eigen::SparseMatrix<double> ends_;  ///< T of end_rows.h; empty where it is the identity
  Vector mortarSpacing_;
  Vector distance_;
  Datum given_;
  std::vector<std::pair<int, SpacePoint>> gapNodes_;  ///< where it is given, with their places
  Eigen::SparseMatrix<double> N_;                     ///< g0 = N times what is given by node
  bool axisymmetric_ = false;
  Vector lengths_;
  double overlap_ = 0;
  double sagitta_ = 0;
  double patchError_ = 0;
  double polygonTurn_ = 0;
  int heldEnds_ = 0;
  PenetrationIntegral penetration_;
  SurfacePoints points_;  ///< in space
  SurfacePoints nearest_;
};

}  // namespace mortier
