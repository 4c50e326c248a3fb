// One deformable body: a mesh, a material, its supports and its loads. It has nothing of contact.
#pragma once

#include <Eigen/SparseCore>
#include <array>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "base/parallel.h"
#include "base/two_part_vector.h"
#include "base/types.h"
#include "fem/supports.h"
#include "fem/volume_patches.h"
#include "linear/condensing_solver.h"
#include "material/material.h"
#include "mesh/element_nodes.h"
#include "mesh/triangle_mesh.h"

namespace mortier {

class TangentAssembly;

/// Force per volume, one component [N/m^3].
struct BodyForce {
  int component = 0;
  Datum value = {};
};

/// Stress at t = 0, one component (0: s11, 1: s22, 2: s12, 3: s33 in plane strain, around the axis or in
/// space, 4: s13, 5: s23), in a region or everywhere [Pa]; later ones replace earlier ones.
struct InitialStress {
  int component = 0;
  std::optional<int> region;
  Datum value = {};
};

/// What moves a body that does not strain: along x and y, and by an angle about a point, counterclockwise; in
/// space along x, y, z and by angles about these axes. Its displacements are those of linear theory,
/// u = theta x (x - at): rows of contact keep their normals, so that a disc that turns about its centre stays
/// where it is. Where contact follows it and it may turn, they stand for the motions, and its nodes are where
/// a rotation by theta, in space by the vector of the angles, takes them (Body::moved).
struct RigidMotion {
  SpacePoint at;                     ///< z = 0 in the plane [m]
  std::vector<Datum> held;           ///< [m] and [rad], functions of time; empty where the motion is free
  std::vector<Datum> force;          ///< of free motions [N/m], [N], in space [N], [N m]; may be empty
  bool turns = false;                ///< by finite angles
  std::vector<bool> whereItIs = {};  ///< by motions: held as in the state in which the run begins; or empty
  bool surface = true;               ///< whether it has one; else ties alone take its motion
};

struct Conditions {
  std::vector<Condition> displacements = {};
  std::vector<Condition> tractions = {};
  std::vector<BodyForce> forces = {};
  std::vector<InitialStress> initialStresses = {};
  Datum temperature = {};  ///< above that at which nothing is strained [K]
  /// Thermal strain per kelvin, components of the tensor x points [1/K]; empty where there is no temperature.
  Matrix expansion = {};
  std::optional<RigidMotion> rigid = {};  ///< of a body that has no material, and none of the above
};

/// Places of the quadrature points of all triangles or tetrahedra, one element after the other [m].
std::vector<Point> placesOfPoints(const TriangleMesh& mesh, int degree);
std::vector<SpacePoint> placesOfPoints(const TetrahedronMesh& mesh, int degree);

/// The tetrahedra of a body in space, and the nodes of its displacements.
class SpaceElements {
 public:
  SpaceElements(TetrahedronMesh mesh, int degree)
      : mesh_(std::move(mesh)), nodes_(spaceNodes(mesh_, degree)) {}
  [[nodiscard]] const TetrahedronMesh& mesh() const { return mesh_; }
  [[nodiscard]] const SpaceNodes& nodes() const { return nodes_; }

 private:
  TetrahedronMesh mesh_;
  SpaceNodes nodes_;
};

class Body {
 public:
  /// \param degree  of the displacements, 1 or 2
  /// \param axisymmetric  whether it turns about the axis x = 0 (mesh/triangle_mesh.h): the material has four
  /// components then, integrals are of the whole ring, and forces are in [N]
  /// \param averaged  whether its material gets an averaged volumetric strain (fem/volume_patches.h)
  /// \throws InputError when a condition names a label or a point that the mesh does not have, where a
  /// triangle with a curved side is turned inside out, or where the mesh lies beyond the axis.
  Body(std::string name, TriangleMesh mesh, std::shared_ptr<const Material> material, Conditions conditions,
       int degree = 1, bool axisymmetric = false, bool averaged = false);
  /// A body in space. Of what follows below, what refers to triangles and axes of revolution is of the plane,
  /// and empty. \throws InputError
  Body(std::string name, TetrahedronMesh mesh, std::shared_ptr<const Material> material,
       Conditions conditions, int degree, bool averaged = false);

  [[nodiscard]] const std::string& name() const { return name_; }
  /// 2 or 3: components of a displacement. A dof is dimension() node + component.
  [[nodiscard]] int dimension() const { return space_ ? 3 : 2; }
  /// Its tetrahedra; null in the plane.
  [[nodiscard]] const SpaceElements* space() const { return space_.get(); }
  [[nodiscard]] const TriangleMesh& mesh() const { return mesh_; }
  /// Calls work(mesh, nodes) with its triangles or its tetrahedra.
  template <class Work>
  decltype(auto) withMesh(const Work& work) const {
    return space_ ? work(space_->mesh(), space_->nodes()) : work(mesh_, nodes_);
  }
  /// Of elements.
  [[nodiscard]] const std::vector<int>& regions() const {
    return withMesh([](const auto& mesh, const auto&) -> const std::vector<int>& { return mesh.regions; });
  }
  /// Nodes of all elements, one element after the other.
  [[nodiscard]] const std::vector<int>& nodesOfElements() const {
    return withMesh([](const auto&, const auto& nodes) -> const std::vector<int>& { return nodes.elements; });
  }
  [[nodiscard]] std::span<const int> nodesOf(size_t element) const {
    const size_t count = nodesOfElements().size() / elements();
    return {nodesOfElements().data() + count * element, count};
  }
  /// "triangles" or "tetrahedra".
  [[nodiscard]] const char* elementsWord() const { return space_ ? "tetrahedra" : "triangles"; }
  [[nodiscard]] const Material& material() const { return *material_; }
  /// Nodes of the displacement: the vertices of the mesh, and what lies between them.
  [[nodiscard]] const ElementNodes& elementNodes() const { return nodes_; }
  [[nodiscard]] int degree() const { return space_ ? space_->nodes().degree : nodes_.degree; }
  [[nodiscard]] bool axisymmetric() const { return axisymmetric_; }
  /// Where the volumetric strain is averaged; null elsewhere.
  [[nodiscard]] const VolumePatches* patches() const { return patches_ ? &*patches_ : nullptr; }
  [[nodiscard]] int nodes() const { return space_ ? space_->nodes().count() : nodes_.count(); }
  [[nodiscard]] int dofs() const { return dimension() * nodes(); }
  /// Triangles or tetrahedra.
  [[nodiscard]] size_t elements() const {
    return space_ ? space_->mesh().tetrahedra.size() : mesh_.triangles.size();
  }
  /// Quadrature points, triangle by triangle: columns of stresses, strains and moduli.
  [[nodiscard]] int points() const { return static_cast<int>(weights_.size()); }
  /// Quadrature weights, the area in all [m^2], or the volume of the whole ring [m^3].
  [[nodiscard]] const std::vector<double>& weights() const { return weights_; }
  /// What an area or a length at a place of the mesh stands for: times 1, or the circumference [m].
  [[nodiscard]] double depthAt(const Point& place) const { return axisymmetric_ ? circumference(place) : 1; }

  [[nodiscard]] int pointsOfTriangle() const;
  /// Largest extent of the bounding box; that of the whole body [m].
  [[nodiscard]] double extent() const { return extent_; }

  /// Of any vertex, without sign [m].
  [[nodiscard]] double largestCoordinate() const;
  /// Place of a point; z = 0 in the plane [m].
  [[nodiscard]] SpacePoint placeOfPoint(int point) const;
  /// Place of a node; z = 0 in the plane [m].
  [[nodiscard]] SpacePoint placeOfNode(int node) const;
  /// Of a triangle or a tetrahedron: the mean of its vertices; z = 0 in the plane [m].
  [[nodiscard]] SpacePoint centreOf(size_t element) const;
  /// Nodes of the labelled boundary, or of one label, ascending.
  [[nodiscard]] std::vector<int> boundaryNodes(std::optional<int> label = {}) const;
  /// Places of the points of triangles [m].
  [[nodiscard]] std::vector<Point> places() const;

  // Equations (Supports).

  [[nodiscard]] int freeDofs() const { return supports_.freeDofs(); }

  /// Whether it does not strain. Then it has no points, no tangent and no equations of nodes: its free dofs
  /// are the motions that are not prescribed, and gather() takes the work of nodal forces on them.
  [[nodiscard]] bool rigid() const { return conditions_.rigid.has_value(); }
  /// Whether another body can touch it.
  [[nodiscard]] bool hasSurface() const { return !rigid() || conditions_.rigid->surface; }
  /// These motions by dofs, [m] per unit. \pre rigid()
  [[nodiscard]] const Matrix& freeMotions() const { return freeMotions_; }
  /// Displacement at the reference point and angles of a rigid displacement (dofs). \pre rigid()
  [[nodiscard]] Vector motionOf(const Vector& displacement) const { return toMotion_ * displacement; }
  /// Of each dof in one of these motions. \pre rigid()
  [[nodiscard]] Vector sharesIn(int motion) const { return toMotion_.row(motion); }
  /// The reverse of motionOf(). \pre rigid()
  [[nodiscard]] Vector displacementOf(const Vector& motion) const { return motions_ * motion; }
  /// The number of the rotation about an axis (0: x) among the motions. \pre rigid()
  [[nodiscard]] int rotationAbout(int axis) const { return dimension() == 3 ? 3 + axis : 2; }
  /// Resultants and moments about the reference point of nodal forces (dofs), of those components that are
  /// prescribed: the others are zero. \pre rigid()
  [[nodiscard]] Vector heldForce(const Vector& nodal) const;

  /// Whether it turns by finite angles.
  [[nodiscard]] bool turns() const { return rigid() && conditions_.rigid->turns; }
  /// By what its nodes are moved (dofs), where it turns; else by the displacement itself.
  [[nodiscard]] Vector moved(const Vector& displacement) const;
  /// d moved(u) / du for u that are rigid: dofs x dofs, the rows of some nodes, from two or three of these.
  [[nodiscard]] Eigen::SparseMatrix<double> changeOfMoved(const Vector& displacement,
                                                          const std::vector<int>& nodes) const;

  /// Equation of each dof; -1 where that motion is prescribed.
  [[nodiscard]] const std::vector<int>& equations() const { return supports_.equations(); }
  /// A vector at a node by the equations of the node (-1 where prescribed).
  struct Part {
    int equation = -1;
    double value = 0;
  };
  [[nodiscard]] std::array<Part, 2> parts(int node, const Point& vector) const;
  /// The same in space; in the plane the third part is nothing.
  [[nodiscard]] std::array<Part, 3> parts(int node, const SpacePoint& vector) const;
  /// Nodal vectors (dofs) to equations; what acts along prescribed motions is left out.
  [[nodiscard]] Vector gather(const Vector& nodal) const {
    return rigid() ? Vector(freeMotions_.transpose() * nodal) : supports_.gather(nodal);
  }
  /// The reverse: dofs, nothing along prescribed motions.
  [[nodiscard]] Vector spread(const Vector& x) const {
    return rigid() ? Vector(freeMotions_ * x) : supports_.spread(x);
  }

  [[nodiscard]] const Conditions& conditions() const { return conditions_; }
  /// Conditions that hold it where it is hold it at this displacement (dofs).
  void holdAt(const Vector& displacement);
  [[nodiscard]] const Supports& supports() const { return supports_; }
  /// Writes the prescribed displacements at time t into `u` (dofs).
  void prescribe(double t, Vector& u) const;
  /// Gives an increment (dofs) what prescribed displacements change by from t0 to t1: taken from the
  /// displacements themselves, their rounding would strain the body.
  void prescribeIncrement(double t0, double t1, TwoPartVector& increment) const;
  /// Nodal forces (dofs) of tractions and body forces at time t: the integrals of the data, resolved
  /// (base/adaptive_quadrature.h) where the rule of the element does not integrate them [N/m].
  [[nodiscard]] Vector load(double t) const;

  /// Of a shape function, the largest component in any triangle of the whole body [1/m].
  [[nodiscard]] double largestGradient() const { return largestGradient_; }

  /// Stress at t = 0 (components x points) [Pa].
  [[nodiscard]] Matrix initialStress() const;
  /// Whether the body has a temperature that strains it.
  [[nodiscard]] bool heated() const { return conditions_.expansion.rows() > 0; }
  /// Thermal strain at time t (components x points) [-]. \pre heated()
  [[nodiscard]] Matrix thermalStrain(double t) const;
  [[nodiscard]] bool hasInitialStress() const { return !conditions_.initialStresses.empty(); }
  /// sum |T| B' s: nodal forces (dofs) of a stress field (components x points) [N/m].
  [[nodiscard]] Vector internalForce(const Matrix& stress) const;
  /// The largest nodal force of any one triangle [N/m]: what their sum is rounded against, also where
  /// stresses balance each other.
  [[nodiscard]] double largestForce(const Matrix& stress) const;
  /// B u - shift (components x points; no shift where null) of a displacement (dofs) in two parts, in twice
  /// the working precision: a triangle that is still elastic next to one that flows has tiny differences of
  /// large displacements, and where stress relaxes almost all of B u is shift. Fills the columns [begin,
  /// end).
  void strain(const TwoPartVector& u, const Matrix* shift, Matrix& strain, int begin, int end) const;
  /// stress += H^-1 B d in the columns [begin, end), d by dofs.
  void addStressOf(const Vector& d, const Linearisation& law, Matrix& stress, int begin, int end) const;

  /// Pattern of the tangent over equations; symmetric where the material's tangent is. It is found when the
  /// tangent is first asked for: not to be called first by several threads at once.
  [[nodiscard]] const SparsePattern& pattern() const;
  /// K = sum |T| B' H^-1 B as values of pattern(). \param moduli  those of Linearisation; about an axis that
  /// is asked for
  void tangent(const Matrix& moduli, std::vector<double>& values, Threads& threads = Threads::none()) const;
  void tangent(const Linearisation& law, std::vector<double>& values,
               Threads& threads = Threads::none()) const;

 private:
  /// What the elements are at their points. \param mesh  its name
  template <class Nodes>
  void tabulate(const Nodes& nodes, const std::string& mesh);
  void findMotions();
  /// A rigid displacement (dofs) with prescribed components in place of its own. \param held  their values
  [[nodiscard]] Vector withHeld(const Vector& held, const Vector& displacement) const;
  [[nodiscard]] Vector heldAt(double t) const;
  [[nodiscard]] Vector rigidLoad(double t) const;
  [[nodiscard]] const TangentAssembly& assembly() const;
  /// Calls work(ElementData) with its triangles or tetrahedra.
  template <class Work>
  auto withElements(const Work& work) const;
  void hoopStrain(const TwoPartVector& u, const Matrix* shift, Matrix& strain, int begin, int end) const;
  void averageStrain(const TwoPartVector& u, const Matrix* shift, Matrix& strain, int begin, int end) const;
  void strainInSpace(const TwoPartVector& u, const Matrix* shift, Matrix& strain, int begin, int end) const;
  void addStressInSpace(const Vector& d, const Linearisation& law, Matrix& stress, int begin, int end) const;
  template <class Element>
  void strainOf(const TwoPartVector& u, const Matrix* shift, Matrix& strain, int begin, int end) const;
  // Of data that do not change and the rule of the element does not integrate, or of all others.
  [[nodiscard]] Vector spaceLoad(double t) const;
  void addTractions(double t, Vector& f, bool steady) const;
  void addForces(double t, Vector& f, bool steady) const;
  void addPointForces(double t, Vector& f) const;
  void findSteadyLoads();
  /// A datum at the points: in the plane its projection onto what stresses can be.
  [[nodiscard]] Vector atPoints(const Datum& datum, double t) const;

  std::string name_;
  std::shared_ptr<const SpaceElements> space_;  ///< null in the plane
  TriangleMesh mesh_;
  ElementNodes nodes_;
  std::shared_ptr<const Material> material_;
  Conditions conditions_;
  Supports supports_;
  std::vector<double> weights_;
  std::vector<double>
      gradients_;  ///< of all shape functions of an element but the first, over sqrt2, by points
  bool axisymmetric_ = false;
  std::vector<double> hoops_;  ///< of all shape functions of a triangle their value over r, by points
  std::optional<VolumePatches> patches_;
  // Of a rigid body: its motions by dofs, those that are free, and what finds them of a rigid displacement.
  [[nodiscard]] SpacePoint turnOf(const Vector& motion) const;
  Matrix motions_, freeMotions_, toMotion_;
  double largestGradient_ = 0;
  double extent_ = 0;
  Vector steady_;  ///< nodal forces of findSteadyLoads(), by dofs; empty where there are none
  mutable std::shared_ptr<const TangentAssembly> assembly_;
};

}  // namespace mortier
