// The tetrahedra of a body in space, its supports and loads: what a Body is made of there (fem/body.h).
//
// Stress and strain are vectors of six components (material/deviatoric.h).
#pragma once

#include <functional>
#include <optional>
#include <string>
#include <vector>

#include "base/parallel.h"
#include "base/two_part_vector.h"
#include "base/types.h"
#include "fem/volume_patches.h"
#include "linear/condensing_solver.h"
#include "material/material.h"
#include "mesh/tetrahedron_mesh.h"

namespace mortier {

/// Directions of displacements and tractions in space.
enum SpaceComponent : int { spaceX, spaceY, spaceZ, spaceNormal };

/// A displacement [m] or a force per area [Pa] along a direction, on a labelled boundary; or a displacement
/// along an axis at a vertex.
struct SpaceCondition {
  int label = 0;
  int component = 0;
  SpaceDatum value;
  std::optional<SpacePoint> point = {};  ///< where the vertex is, in place of the label [m]
};

/// Stress at t = 0, one component (0: s11, 1: s22, 2: s12, 3: s33 in plane strain, around the axis or in
/// space, 4: s13, 5: s23), in a region or everywhere [Pa]; later ones replace earlier ones.
template <class Value>
struct InitialStressOf {
  int component = 0;
  std::optional<int> region;
  Value value;
};

struct SpaceConditions {
  std::vector<SpaceCondition> displacements;
  std::vector<SpaceCondition> tractions;
  std::vector<SpaceCondition> forces = {};  ///< per volume, along the axes [N/m^3]; labels have no meaning
  std::vector<InitialStressOf<SpaceDatum>> initialStresses = {};
  SpaceDatum temperature = {};  ///< as in Conditions (fem/body.h)
  Matrix expansion = {};
};

/// A node of which one motion or more are prescribed.
struct SpaceSupport {
  int node = 0;
  int count = 0;                              ///< prescribed motions: 1 to 3
  Eigen::Matrix3d directions;                 ///< rows: unit vectors, the first `count` independent
  std::array<int, 3> conditions{-1, -1, -1};  ///< that prescribe them
  bool turned = false;                        ///< whether any direction is no axis
  /// Orthonormal rows; the first `count` span the prescribed directions. The equations of a turned node are
  /// those of the others.
  Eigen::Matrix3d frame;
};

/// Places of the quadrature points of all tetrahedra, one after the other [m].
std::vector<SpacePoint> placesOfPoints(const TetrahedronMesh& mesh, int degree);

class SpaceElements {
 public:
  /// \param averaged  whether the material gets an averaged volumetric strain; with degree 1 alone
  /// \throws InputError when a condition names a label or a point that the mesh does not have.
  SpaceElements(const std::string& body, TetrahedronMesh mesh, SpaceConditions conditions, int degree,
                bool averaged);

  [[nodiscard]] const TetrahedronMesh& mesh() const { return mesh_; }
  [[nodiscard]] const SpaceNodes& nodes() const { return nodes_; }
  [[nodiscard]] const SpaceConditions& conditions() const { return conditions_; }
  [[nodiscard]] const std::vector<SpaceSupport>& supports() const { return supports_; }
  [[nodiscard]] int pointsOfElement() const { return nodes_.degree == 1 ? 1 : 4; }
  /// Of the quadrature points, tetrahedron by tetrahedron [m^3].
  [[nodiscard]] const std::vector<double>& weights() const { return weights_; }
  [[nodiscard]] SpacePoint placeOf(int point) const;  ///< [m]
  [[nodiscard]] double largestGradient() const { return largestGradient_; }
  /// Where the volumetric strain is averaged; null elsewhere.
  [[nodiscard]] const VolumePatches* patches() const { return patches_ ? &*patches_ : nullptr; }

  // As those of Body.

  [[nodiscard]] const std::vector<int>& equations() const { return equations_; }
  [[nodiscard]] int freeDofs() const { return freeDofs_; }
  /// A vector at a node by the directions of its equations.
  [[nodiscard]] SpacePoint inFrame(int node, const SpacePoint& vector) const;
  [[nodiscard]] Vector gather(const Vector& nodal) const;
  [[nodiscard]] Vector spread(const Vector& x) const;
  void prescribe(double t, Vector& u) const;
  void prescribeIncrement(double t0, double t1, TwoPartVector& increment) const;
  [[nodiscard]] Vector load(double t) const;
  [[nodiscard]] Vector internalForce(const Matrix& stress) const;
  [[nodiscard]] double largestForce(const Matrix& stress) const;
  void strain(const TwoPartVector& u, const Matrix* shift, Matrix& strain, int begin, int end) const;
  void addStressOf(const Vector& d, const Linearisation& law, Matrix& stress, int begin, int end) const;
  [[nodiscard]] const SparsePattern& pattern(bool symmetric) const;
  void tangent(const Matrix& moduli, std::vector<double>& values, Threads& threads) const;

 private:
  void findSupports(const std::string& body);
  void numberEquations();
  void buildPattern(bool symmetric) const;
  [[nodiscard]] SpacePoint prescribedAt(const SpaceSupport& support, double t) const;
  template <class Element>
  [[nodiscard]] Eigen::Matrix<double, 3 * Element::nodes, 3 * Element::nodes> elementTangent(
      int element, const Matrix& moduli) const;
  void averageStrain(const TwoPartVector& u, const Matrix* shift, Matrix& strain, int begin, int end) const;
  void setPatch(int patch, const Matrix& moduli, PatchTangent& tangent) const;
  template <class Entry>
  void add(std::span<const int> nodes, const Entry& entry, std::vector<double>& values) const;

  TetrahedronMesh mesh_;
  SpaceNodes nodes_;
  SpaceConditions conditions_;
  std::vector<SpaceSupport> supports_;  ///< by ascending nodes
  std::vector<int> turnedOf_;           ///< by nodes, their turned support or -1; empty where there are none
  std::vector<int> equations_;
  int freeDofs_ = 0;
  std::vector<double> weights_;
  std::vector<double> gradients_;  ///< of all shape functions of an element but the first, over sqrt2
  double largestGradient_ = 0;
  std::optional<VolumePatches> patches_;
  // The pattern by nodes: the neighbours of each, and how many equations those before them have.
  mutable std::optional<SparsePattern> pattern_;
  mutable std::vector<int> neighbourStart_, neighbours_, before_;
};

}  // namespace mortier
