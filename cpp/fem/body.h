// One deformable body: a mesh, a material, what holds it and what loads it. It knows nothing of contact.
#pragma once

#include <memory>
#include <string>
#include <vector>

#include "base/types.h"
#include "linear/sparse_pattern.h"
#include "material/material.h"
#include "mesh/triangle_mesh.h"

namespace mortier {

/// Displacement `component` (0: x, 1: y) prescribed on a labelled boundary [m].
struct PrescribedDisplacement {
  int label = 0;
  int component = 0;
  Function value;
};

/// Surface force per length on a labelled boundary, one component [N/m per metre of depth, Pa].
struct Traction {
  int label = 0;
  int component = 0;
  Function value;
};

/// Force per volume, one component [N/m^3].
struct BodyForce {
  int component = 0;
  Function value;
};

struct Conditions {
  std::vector<PrescribedDisplacement> displacements;
  std::vector<Traction> tractions;
  std::vector<BodyForce> forces;
};

class Body {
 public:
  /// \throws InputError when a condition names a label that the mesh does not have.
  Body(std::string name, TriangleMesh mesh, std::shared_ptr<const Material> material, Conditions conditions);

  [[nodiscard]] const std::string& name() const { return name_; }
  [[nodiscard]] const TriangleMesh& mesh() const { return mesh_; }
  [[nodiscard]] const Material& material() const { return *material_; }
  [[nodiscard]] int nodes() const { return static_cast<int>(mesh_.vertices.size()); }
  [[nodiscard]] int dofs() const { return 2 * nodes(); }
  /// Quadrature points: columns of stresses, strains and moduli.
  [[nodiscard]] int points() const { return static_cast<int>(weights_.size()); }
  /// Quadrature weights, the area in all [m^2].
  [[nodiscard]] const std::vector<double>& weights() const { return weights_; }
  /// Equation of dof 2 node + component; -1 where the displacement is prescribed.
  [[nodiscard]] const std::vector<int>& equations() const { return equations_; }
  [[nodiscard]] int freeDofs() const { return pattern_.size; }

  /// Writes the prescribed displacements at time t into `u` (dofs).
  void prescribe(double t, Vector& u) const;
  /// Nodal forces (dofs) of tractions and body forces at time t [N/m].
  [[nodiscard]] Vector load(double t) const;

  /// sum |T| B' s: nodal forces (dofs) of a stress field (components x points) [N/m].
  [[nodiscard]] Vector internalForce(const Matrix& stress) const;
  /// B u (3 x points) of a displacement (dofs) carried as u + small, in twice the working precision: a
  /// triangle that is still elastic next to one that flows sees tiny differences of large displacements.
  void strain(const Vector& u, const Vector& small, Matrix& strain) const;
  /// stress += moduli B d, d by dofs.
  void addStressOf(const Vector& d, const Matrix& moduli, Matrix& stress) const;

  /// Pattern of the tangent over equations; symmetric where the material's tangent is.
  [[nodiscard]] const SparsePattern& pattern() const { return pattern_; }
  /// K = sum |T| B' H^-1 B (moduli 9 x points) as values of pattern().
  void tangent(const Matrix& moduli, std::vector<double>& values) const;

 private:
  void numberEquations();
  void buildPattern();

  std::string name_;
  TriangleMesh mesh_;
  std::shared_ptr<const Material> material_;
  Conditions conditions_;
  std::vector<int> equations_;
  SparsePattern pattern_;
  std::vector<double> weights_;
  std::vector<double> gradients_;  ///< 6 per point: gradient of each node's shape function over sqrt2
  std::vector<int> scatter_;  ///< per triangle: entry of pattern_ for each entry of its matrix, -1 for none
};

}  // namespace mortier
